#!/usr/bin/env bash
# Lines of trusted code, file by file and in all: without comments, blank lines and tests.
set -euo pipefail
cd "$(dirname "$0")"
for crate in "${@:-kernel}"; do
  find "$crate/src" -name '*.rs' | sort | while read -r file; do
    # Of a file that is a module of tests, nothing counts.
    awk -v file="$file" '
      /^#!?\[cfg\(test\)\]/ { tests = 1 }
      tests && /^(mod|use) .*;/ { tests = 0; next }
      tests && /^}/ { tests = 0; next }
      !tests && !/^[[:space:]]*(\/\/|$)/ { lines++ }
      END { printf "%5d %s\n", lines, file }
    ' "$file"
  done | awk -v crate="$crate" '{ print; all += $1 } END { printf "%5d %s\n", all, crate }'
done
