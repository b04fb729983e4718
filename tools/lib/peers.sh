# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
# Other people's implementations to test against: a Python environment in .deps/peers, Node packages in .deps/peers-node. And their
# odometry to measure ours by, in .deps/odometry-peers: only tools/bench --peers needs it.

peers_requirements=$root/tools/lib/peers-requirements.txt
peers_stamp=$deps/peers/requirements.txt  # what the environment was made from
odometry_peers_requirements=$root/tools/lib/odometry-peers-requirements.txt

# make_python REQUIREMENTS FOLDER: a Python environment with exactly these packages; it keeps the list it was made from.
make_python() {
  rm -rf "$2"
  python3 -m venv "$2" || return 1
  "$2/bin/pip" install --no-cache-dir --disable-pip-version-check --no-deps -r "$1" || return 1
  cp "$1" "$2/requirements.txt"
}

peers_packages=$root/tools/lib/peers-npm.txt
peers_packages_stamp=$deps/peers-node/packages.txt

make_node_peers() {
  rm -rf "$deps/peers-node"
  mkdir -p "$deps/peers-node"
  (cd "$deps/peers-node" && echo '{"private": true}' >package.json && xargs npm install --ignore-scripts --no-audit --no-fund \
    <"$peers_packages") || return 1
  cp "$peers_packages" "$peers_packages_stamp"
}

install_node_peers() {
  cmp -s "$peers_packages" "$peers_packages_stamp" && return 0
  if ! command -v npm >/dev/null; then
    say "left out: Node peers (no npm, Debian package npm). Tests that need them skip."
    return 0
  fi
  run_step "install Node peers" "They come from npm: a network is needed. Tests labelled peers skip without them." \
    quiet_filter make_node_peers
}

install_peers() {
  local failed=0
  if ! cmp -s "$peers_requirements" "$peers_stamp"; then
    run_step "install Python peers" "They come from PyPI: a network is needed. Tests labelled peers skip without them." \
      pip_filter make_python "$peers_requirements" "$deps/peers" || failed=1
  fi
  install_node_peers || failed=1
  return "$failed"
}

install_odometry_peers() {
  cmp -s "$odometry_peers_requirements" "$deps/odometry-peers/requirements.txt" && return 0
  run_step "install odometry peers" "They come from PyPI: a network is needed." \
    pip_filter make_python "$odometry_peers_requirements" "$deps/odometry-peers"
}
