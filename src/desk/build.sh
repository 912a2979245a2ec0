#!/usr/bin/env bash
# Writes the page that proves while a number is dragged, one file that needs no server and no network:
#   build.sh [DESK.html]        [default: target/desk/desk.html]
# Needs Rust, and for WebAssembly either rustup's target wasm32-unknown-unknown or, of Debian, the
# packages rustc-web, rust-web-src and lld.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=${CARGO_TARGET_DIR:-$here/../../target}/desk
out=${1:-$work/desk.html}
target=wasm32-unknown-unknown

build=(cargo build --release --locked --target "$target" --manifest-path "$here/Cargo.toml" --target-dir "$work")
if [ -e "$(rustc --print target-libdir --target "$target")" ]; then
  "${build[@]}"
else
  # Debian's compiler has no standard library for it, and is built with one from its sources.
  RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1 \
    RUSTFLAGS="-C linker=/usr/bin/wasm-ld -C linker-flavor=wasm-ld" \
    "${build[@]}" -Z build-std=std,panic_abort
fi

parts=$(mktemp -d)
trap 'rm -rf "$parts"' EXIT
base64 -w 0 "$work/$target/release/orthocert_desk.wasm" >"$parts/program"
echo >>"$parts/program"
cat "$here"/{desk,numbers,verdict,keep,start}.js >"$parts/script"
cat "$here"/../report/page/{page,figure}.css "$here/desk.css" >"$parts/style"
cp "$here/worker.js" "$parts/worker"

# What the page may do: run its own script and program, and ask nothing of anybody.
hash() {
  local digits
  digits=$( (echo; cat "$1") | sha256sum | cut -c 1-64 | sed 's/../\\x&/g')
  printf '%b' "$digits" | base64
}
cat >"$parts/policy" <<POLICY
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'sha256-$(hash "$parts/script")' 'wasm-unsafe-eval'; worker-src blob:; style-src 'sha256-$(hash "$parts/style")'; base-uri 'none'; form-action 'none'">
POLICY

mkdir -p "$(dirname "$out")"
while IFS= read -r line; do
  case $line in
    '{{'*'}}') name=${line//[\{\}]/}; cat "$parts/$name" ;;
    *) printf '%s\n' "$line" ;;
  esac
done <"$here/desk.html" >"$out"
echo "$out: $(wc -c <"$out") bytes"
