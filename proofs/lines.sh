#!/bin/sh
# Counts trusted lines of proofs/checker and proofs/kernel, folder by folder: of src, Rust without comments,
# blank lines and tests (folders `tests`, modules `tests` behind #[cfg(test)] or cfg(all(test, ..))).
set -eu
cd "$(dirname "$0")"

# Lines of code of the files given, less unit tests, which stand at the end of their file.
count() {
    awk '
        FNR == 1 { tests = 0 }
        /^#\[cfg\((test|all\(test)/ { tests = 1 }
        tests { next }
        { line = $0; sub(/^[ \t]+/, "", line) }
        line == "" || line ~ /^\/\// { next }
        { n++ }
        END { print n + 0 }
    ' "$@"
}

total=0
for crate in checker kernel; do
    sum=0
    for folder in $(find "$crate/src" -type d | sort); do
        files=$(find "$folder" -maxdepth 1 -name '*.rs' | sort)
        [ -n "$files" ] || continue
        # shellcheck disable=SC2086
        lines=$(count $files)
        printf '%6d  %s\n' "$lines" "$folder"
        sum=$((sum + lines))
    done
    printf '%6d  %s\n\n' "$sum" "$crate"
    total=$((total + sum))
done
printf '%6d  checker and kernel\n' "$total"
