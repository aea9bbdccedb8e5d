#!/bin/sh
# commit.sh ROOT - prints " (COMMIT)" as it stands in a string of C: 12 digits, and + where the sources have changed
# since. Of an archive it is what the file COMMIT at its top says; without that nothing.
cd "$1" || exit 0
commit=
if [ -e .git ]; then
  commit=$(git rev-parse --verify -q HEAD 2>/dev/null | cut -c 1-12)
  [ -z "$commit" ] || [ -z "$(git status --porcelain --untracked-files=no 2>/dev/null)" ] || commit=$commit+
elif [ -f COMMIT ]; then
  commit=$(tr -cd '0-9a-f+' <COMMIT | cut -c 1-13)
fi
[ -z "$commit" ] || printf '\\040(%s)\n' "$commit"
