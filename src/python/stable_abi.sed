# Makes the list of what python3.dll gives from stable_abi.h, for dlltool.
1s/.*/LIBRARY python3.dll\nEXPORTS/p
s/^PYTHON .* \**(\{0,1\}\(_*Py[A-Za-z0-9_]*\))\{0,1\}(.*/\1/p
s/^PYTHON .* \(_*Py[A-Za-z0-9_]*\);/\1 DATA/p
