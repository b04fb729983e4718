# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
# Debian packages: which are missing, and how to get them. The list is apt-packages.txt.

package_list=$root/tools/lib/apt-packages.txt

# missing_packages GROUP: names of the group's packages that are not installed, one a line.
missing_packages() {
  local wanted
  wanted=$(awk -v group="$1" '$1 == group {print $2}' "$package_list")
  # shellcheck disable=SC2086
  comm -23 <(sort <<<"$wanted") \
    <(dpkg-query -W -f='${db:Status-Status} ${Package}\n' $wanted 2>/dev/null | awk '$1 == "installed" {print $2}' | sort)
}

# as_root COMMAND...: directly for root, through sudo for others; 1 where neither is possible.
as_root() {
  if ((EUID == 0)); then
    "$@"
  elif command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [[ -t 0 ]]; }; then
    sudo "$@"
  else
    say "needs root, and sudo is not available to $(id -un)"
    return 1
  fi
}

apt_get() {
  as_root env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 -o APT::Status-Fd=1 "$@"
}

apt_update_and_install() {
  apt_get update && apt_get install -y --no-install-recommends "$@"
}

what_for() { awk -v package="$1" '$2 == package {$1 = $2 = ""; print substr($0, 3)}' "$package_list"; }

# install_group GROUP: installs what is missing. Where that is impossible it names the packages and what they are for.
install_group() {
  local missing package
  mapfile -t missing < <(missing_packages "$1")
  ((${#missing[@]})) || return 0
  if run_step "install ${#missing[@]} Debian packages" \
    "The packages come from Debian's archive: root (or sudo) and a network are needed." \
    apt_filter apt_update_and_install "${missing[@]}"; then
    return 0
  fi
  say "Missing packages:"
  for package in "${missing[@]}"; do say "  $package ($(what_for "$package"))"; done
  say "Install them with: apt-get install --no-install-recommends ${missing[*]}"
  return 1
}
