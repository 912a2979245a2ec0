#!/bin/sh
# Builds orthocert-check from the sources here and prints its SHA-256: proofs/reproduce.sh [FOLDER]
# The bytes depend on the sources, Cargo.lock, the compiler and the linker, and on no path.
set -eu
cd "$(dirname "$0")/.."
root=$(pwd -P)
target=${1:-${CARGO_TARGET_DIR:-$root/target}/reproducible}
# Paths are told to the compiler by other names; of all flags, none other remains.
separator=$(printf '\037')
CARGO_ENCODED_RUSTFLAGS="--remap-path-prefix=$root=.$separator--remap-path-prefix=${CARGO_HOME:-$HOME/.cargo}=cargo"
export CARGO_ENCODED_RUSTFLAGS
cargo build --release --locked --package orthocert-checker --target-dir "$target" \
  --config profile.release.codegen-units=1 --config 'profile.release.strip="symbols"'
rustc --version
sha256sum "$target/release/orthocert-check"
