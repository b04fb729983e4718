# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
"""Which folder may include which: ARCHITECTURE.md, "Folders". Paths are relative to the repository root."""
import re

TOPS = {
    "common": {"common"},
    "kernels": {"common", "kernels"},
    "robot": {"common", "kernels", "robot"},
    "server": {"common", "kernels", "server"},
    "tools": {"common", "kernels", "robot", "server", "tools"},
    "test": {"common", "kernels", "robot", "server", "tools", "test"},
}

# Within common a module sees those of lower levels and itself.
COMMON_LEVELS = [
    {"base"},
    {"time", "log", "config", "thread", "geometry"},
    {"metrics", "sensor", "gaussian"},
    {"map"},
    {"io", "link", "policy"},
]

# Of one level, but a plain foundation for the rest of it.
COMMON_EXCEPTIONS = {("log", "time"), ("config", "time"), ("thread", "time")}

# Within robot and server: the order of the data; a stage may know the types of those before it. What flows
# back comes as a message.
STAGES = {
    "robot": ["drivers", "sync", "tracking", "keyframe", "uplink", "offload", "map", "local_mapping", "render", "config", "app"],
    "server": ["ingest", "masks", "adjust", "optimise", "store", "stream", "cloud", "config", "app"],
}

# Which kernels a module may use, where the architecture says so.
KERNELS_SEEN = {
    "robot/drivers": set(),
    "robot/tracking": {"core", "pointcloud", "image", "splat"},
    "robot/render": {"core", "splat"},
}

# Outside headers with one home.
OUTSIDE = [
    (re.compile(r"^dds/"), {"common/link"}, "Cyclone DDS"),
    (re.compile(r"^(cuda|cuda_runtime|cuda_fp16|device_launch_parameters|cooperative_groups)[a-z_]*\.h$|^(cub|thrust)/"),
     {"kernels"}, "CUDA"),
    (re.compile(r"^spdlog/"), {"common/log"}, "spdlog"),
    (re.compile(r"^toml\+\+/|^toml\.hpp$"), {"common/config"}, "toml++"),
    (re.compile(r"^ceres/"), {"server/adjust"}, "Ceres"),
]

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def module_of(path):
    """'common/base' of 'common/base/bytes.hpp', 'robot/drivers' of 'robot/drivers/livox/x.cpp'."""
    return "/".join(path.split("/")[:2])


def _level(module_name):
    for level, names in enumerate(COMMON_LEVELS):
        if module_name in names:
            return level
    return None


def _common_problem(importer, included):
    user, used = importer.split("/")[1], included.split("/")[1]
    if user == used or (user, used) in COMMON_EXCEPTIONS:
        return None
    levels = _level(user), _level(used)
    if None in levels:
        return f"common/{user if levels[0] is None else used} has no level in test/check/include_rules.py"
    if levels[1] >= levels[0]:
        return f"common/{user} must not include common/{used} (same level or above)"
    return None


def _stage_problem(importer, included):
    top = importer.split("/")[0]
    order, user, used = STAGES[top], importer.split("/")[1], included.split("/")[1]
    for name in (user, used):
        if name not in order:
            return f"{top}/{name} has no place in the order of the data in test/check/include_rules.py"
    if order.index(used) > order.index(user):
        return f"{top}/{user} must not include {top}/{used}, which comes after it in the way of the data"
    return None


def project_include_problem(path, included):
    """Why `path` must not include the project's header `included`, or None."""
    top, used_top = path.split("/")[0], included.split("/")[0]
    if used_top not in TOPS.get(top, set()):
        return f"{top} must not include {used_top}"
    if top == "common":
        return _common_problem(path, included)
    if used_top == "kernels" and module_of(path) in KERNELS_SEEN:
        if included.split("/")[1] not in KERNELS_SEEN[module_of(path)]:
            return f"{module_of(path)} must not include {module_of(included)}"
    if top in STAGES and used_top == top:
        return _stage_problem(path, included)
    return None


def outside_include_problem(path, included):
    """Why `path` must not include the outside header `included`, or None. A test may do what its module may."""
    home = path.removeprefix("test/")
    for pattern, places, name in OUTSIDE:
        if pattern.search(included) and not any(home.startswith(place + "/") for place in places):
            return f"{name} headers belong to {', '.join(sorted(places))} only"
    return None


def include_problems(path, text):
    """(line, sentence) for every include of the file that breaks a rule."""
    problems = []
    for match in INCLUDE.finditer(text):
        included = match.group(2)
        is_ours = included.split("/")[0] in TOPS and "/" in included
        problem = (project_include_problem if is_ours else outside_include_problem)(path, included)
        if problem:
            problems.append((text.count("\n", 0, match.start(2)) + 1, f"{included}: {problem}"))
    return problems
