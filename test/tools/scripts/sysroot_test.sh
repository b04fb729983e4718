#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
# tools/lib/sysroot.sh unpacks and repairs made-up packages as a root file system would have them.  usage: sysroot_test.sh ROOT
source "$1/tools/lib/common.sh"
source "$root/tools/lib/apt.sh"
source "$root/tools/lib/sysroot.sh"
command -v dpkg-deb >/dev/null || die "SKIP: dpkg-deb is not installed"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
expect() { # expect WHAT COMMAND...
  local what=$1
  shift
  local status=0
  "$@" >"$work/saying" 2>&1 || status=$?
  mv "$work/saying" "$work/said" # which the command could still read
  ((status)) || return 0
  failures=$((failures + 1))
  echo "not so: $what ($*)"
  cat "$work/said"
}
refuse() { ! "$@"; }

package() { # package NAME: of what lies in $work/NAME
  mkdir -p "$work/$1/DEBIAN" "$work/archives"
  printf 'Package: %s\nVersion: 1\nArchitecture: arm64\nMaintainer: nobody <nobody@example.org>\nDescription: none\n' "$1" \
    >"$work/$1/DEBIAN/control"
  dpkg-deb --root-owner-group --build "$work/$1" "$work/archives/$1.deb" >/dev/null
}
triple=aarch64-linux-gnu
# One package puts its library in /lib, another's link means it by its place on the target.
mkdir -p "$work"/{libone/lib/$triple,libone-dev/usr/lib/$triple/blas,libone-dev/usr/share/doc/libone}
echo one >"$work/libone/lib/$triple/libone.so.1"
ln -s /lib/$triple/libone.so.1 "$work/libone-dev/usr/lib/$triple/libone.so"
ln -s libone.so "$work/libone-dev/usr/lib/$triple/libalso.so"
echo blas >"$work/libone-dev/usr/lib/$triple/blas/libblas.so.3"
echo words >"$work/libone-dev/usr/share/doc/libone/README"
package libone
package libone-dev

sysroot=$work/sysroot
mkdir "$sysroot"
expect "unpacking" sysroot_unpack "$work/archives" "$sysroot"
expect "it says how far it is" grep -q '^unpacked 2/2 libone.deb' "$work/said"
expect "repairing" sysroot_repair "$sysroot"
expect "/lib is /usr/lib" test "$(readlink "$sysroot/lib")" = usr/lib
expect "what a package has in /lib lies in /usr/lib" test -f "$sysroot/usr/lib/$triple/libone.so.1"
expect "an absolute link leads into the sysroot" grep -q one "$sysroot/usr/lib/$triple/libone.so"
expect "and is relative" test "$(readlink "$sysroot/usr/lib/$triple/libone.so")" = "../../../lib/$triple/libone.so.1"
expect "a relative link stays" test "$(readlink "$sysroot/usr/lib/$triple/libalso.so")" = libone.so
expect "BLAS is found by its name" grep -q blas "$sysroot/usr/lib/$triple/libblas.so.3"
expect "no documents" test ! -e "$sysroot/usr/share/doc"
expect "no link leads out" test -z "$(find "$sysroot" -type l -lname '/*')"

printf 'cut' >"$work/archives/cut.deb"
mkdir "$work/other"
expect "a damaged package is an error" refuse sysroot_unpack "$work/archives" "$work/other"
mkdir "$work/nothing" "$work/third"
expect "no package is an error" refuse sysroot_unpack "$work/nothing" "$work/third"

expect "without a stamp it is not current" refuse sysroot_is_current "$sysroot"
sysroot_packages >"$(sysroot_stamp "$sysroot")"
expect "with today's list it is" sysroot_is_current "$sysroot"
echo libnew-dev >>"$(sysroot_stamp "$sysroot")"
expect "with another list it is not" refuse sysroot_is_current "$sysroot"
for wanted in libeigen3-dev libtbb-dev libhwy-dev cyclonedds-dev libaravis-dev libopencv-dnn-dev libc6-dev; do
  expect "the sysroot has $wanted" grep -qx "$wanted" <(sysroot_packages)
done
expect "the sysroot has no programs" refuse grep -qx -e cmake -e g++ -e cyclonedds-tools <(sysroot_packages)

# Through the whole command, with a stand-in for apt-get that has no network.
mkdir "$work/bin"
printf '#!/bin/sh\necho "E: no network"\nexit 100\n' >"$work/bin/apt-get"
chmod +x "$work/bin/apt-get"
expect "a failed download is an error" refuse env PATH="$work/bin:$PATH" "$root/tools/sysroot" --dir "$work/made"
expect "that says what to do" grep -q 'a network is needed' "$work/said"
expect "and leaves nothing that looks whole" test ! -e "$work/made"

echo "$failures failures"
exit $((failures > 0))
