# The source, with that of every library: it builds without a network. Read by release.sh.
pack "$work" "ffd-$version" "ffd-$version.tar.xz"
