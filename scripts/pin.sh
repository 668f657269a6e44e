#!/usr/bin/env bash
# Writes the versions that an environment has as constraints.txt.
# usage: scripts/pin.sh PYTHON
set -euo pipefail
cd "$(dirname "$0")/.."
pins=$("$1" -m pip freeze --all --exclude-editable | grep -v -e '^#' -e ' @ ' -e '^setuptools==')
# Where there is no open3d-cpu wheel, open3d of the same version takes its place.
pins+=$'\n'$(sed -n 's/^open3d-cpu==/open3d==/p' <<<"$pins")
{
    echo "# The versions this project is tested with, on Python 3.11 to 3.13; made by: make pins"
    LC_ALL=C sort -f -u <<<"$pins"
} >constraints.txt
