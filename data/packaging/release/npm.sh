# The package for npm. Read by release.sh.
set -eu
sh "$root/data/packaging/npm.sh" "$made"
