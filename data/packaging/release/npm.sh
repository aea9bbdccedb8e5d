# The package for npm. Read by release.sh.
set -eu
sh "$source/data/packaging/npm.sh" "$made" "$work/npm"
