# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
# A Python environment with other people's implementations to test against: .deps/peers.

peers_requirements=$root/tools/lib/peers-requirements.txt
peers_stamp=$deps/peers/requirements.txt  # what the environment was made from

make_peers() {
  rm -rf "$deps/peers"
  python3 -m venv "$deps/peers" || return 1
  "$deps/peers/bin/pip" install --no-cache-dir --disable-pip-version-check --no-deps -r "$peers_requirements" || return 1
  cp "$peers_requirements" "$peers_stamp"
}

install_peers() {
  cmp -s "$peers_requirements" "$peers_stamp" && return 0
  run_step "install Python peers" "They come from PyPI: a network is needed. Tests labelled peers skip without them." \
    pip_filter make_peers
}
