#!/bin/sh
# Proves the designs again and writes the instances anew: `regenerate.sh [ORTHOCERT]`, from any
# folder. A search that has not changed gives the same files, bit by bit.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../../.." && pwd)
orthocert=${1:-$root/target/release/orthocert}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

instance() { # name of the instance, design
    "$orthocert" verify "$2" -o "$work/$1.json" > /dev/null
    "$orthocert" export rocq "$work/$1.json" -o "$here/$1.v"
}

postulate() { # name of the instance, flags
    name=$1
    shift
    "$orthocert" postulate "$@" -o "$work/$name.json" > /dev/null
    "$orthocert" export rocq "$work/$name.json" -o "$here/$name.v"
}

instance OrthoglideTolerance "$root/tests/designs/orthoglide-tolerance.toml"
instance LinearDelta "$here/linear-delta.toml"
postulate PostulateAll --all
postulate PostulateUpTo2 --psi-range 1.5..2

# Of the kernel: the certificates that its own tests prove, and the values that they compute
# (ORTHOCERT_WRITE=1 cargo test -p orthocert-kernel rocq writes them anew).
for name in FourSliders StrutsAndPlane; do
    "$orthocert" export rocq "$here/$name.cert.json" -o "$here/$name.v"
done
