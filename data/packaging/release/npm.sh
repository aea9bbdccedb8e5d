# The package for npm (part of release.sh).
sh "$source/data/packaging/npm.sh" "$made" "$work/npm"
