# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
# An aarch64 sysroot of Debian's arm64 packages. Sourced after common.sh and apt.sh.
# apt gets lists, status and archives of its own, so that the machine stays of one architecture: Debian's OpenCV cannot be
# installed for two at once.

sysroot_stamp() { printf '%s/.edgesplat-sysroot' "$1"; }

# Libraries with their headers; programs (cmake, idlc) run on this machine and are not wanted. libstdc++ comes with the
# cross compiler, what a program needs of it to run with libstdc++6.
sysroot_packages() {
  awk '$1 == "build" && $2 ~ /-dev$/ {print $2}' "$package_list"
  printf '%s\n' libc6-dev libstdc++6 libgcc-s1
}

# sysroot_is_current DIR: made to the end, from today's list.
sysroot_is_current() { [[ -f $(sysroot_stamp "$1") ]] && sysroot_packages | cmp -s - "$(sysroot_stamp "$1")"; }

sysroot_apt() {
  apt-get -o APT::Architecture=arm64 -o APT::Architectures::=arm64 -o Dir::State="$sysroot_state" \
    -o Dir::State::status="$sysroot_state/status" -o Dir::Cache="$sysroot_state/cache" -o APT::Sandbox::User=root \
    -o Acquire::Languages=none -o APT::Install-Recommends=0 -o APT::Get::AllowUnauthenticated=0 -o APT::Status-Fd=1 "$@"
}

sysroot_download() {
  mkdir -p "$sysroot_state/lists/partial" "$sysroot_state/cache/archives/partial"
  : >"$sysroot_state/status"
  rm -f "$sysroot_state"/cache/archives/*.deb
  # shellcheck disable=SC2046
  sysroot_apt update && sysroot_apt install -y --download-only $(sysroot_packages)
}

# sysroot_unpack ARCHIVES DIR: says "unpacked N/TOTAL NAME".
sysroot_unpack() {
  local archive count=0 archives=("$1"/*.deb)
  [[ -f ${archives[0]} ]] || { say "no package was downloaded into $1"; return 1; }
  # Debian 12 has all of these in /usr; a link before the first package merges what packages still put outside.
  mkdir -p "$2/usr/bin" "$2/usr/sbin" "$2/usr/lib"
  ln -s usr/bin usr/sbin usr/lib "$2/"
  for archive in "${archives[@]}"; do
    dpkg-deb --fsys-tarfile "$archive" | tar -x --keep-directory-symlink -C "$2" \
      --exclude './usr/share/doc*' --exclude './usr/share/man*' --exclude './usr/share/locale*' || return 1
    count=$((count + 1))
    printf 'unpacked %d/%d %s\n' "$count" ${#archives[@]} "${archive##*/}"
  done
}

unpack_filter() {
  local line
  while IFS= read -r line; do
    [[ $line =~ ^unpacked\ ([0-9]+)/([0-9]+) ]] || continue
    progress "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}" "$(per_second "${BASH_REMATCH[1]}") packages/s"
  done
}

# sysroot_repair DIR: what the packages' install scripts would have done, and paths that mean the target's root.
sysroot_repair() {
  local sysroot=$1 link target name libraries=$1/usr/lib/aarch64-linux-gnu
  while IFS= read -r -d '' link; do
    target=$(readlink "$link")
    ln -sfn "$(realpath -m -s --relative-to="$(dirname "$link")" "$sysroot$target")" "$link" || return 1
  done < <(find "$sysroot" -type l -lname '/*' -print0)
  for name in blas lapack; do # update-alternatives makes these
    [[ ! -f $libraries/$name/lib$name.so.3 ]] || ln -sfn "$name/lib$name.so.3" "$libraries/lib$name.so.3"
  done
}

# make_sysroot DIR: whole or not at all.
make_sysroot() {
  local part=$1.part
  sysroot_state=$1.apt
  rm -rf "$part"
  mkdir -p "$part" "$sysroot_state" || die "sysroot: cannot write to ${1%/*}"
  run_step "download Debian's arm64 packages" \
    "They come from the archive that this machine's apt uses, which must have arm64: a network is needed; behind a proxy set apt's." \
    apt_filter sysroot_download || return 1
  run_step "unpack the sysroot" "Is the disk full? 1.2 GB are needed in ${1%/*}." \
    unpack_filter sysroot_unpack "$sysroot_state/cache/archives" "$part" || return 1
  rm -rf "$1" && mv "$part" "$1"
  run_step "repair the sysroot's links" "Run tools/sysroot --again." quiet_filter sysroot_repair "$1" || return 1
  sysroot_packages >"$(sysroot_stamp "$1")"
  rm -rf "$sysroot_state"
  say "sysroot: $1"
}
