#!/usr/bin/env bash
# Makes a virtual environment with the project and its pinned dependencies in it.
# usage: scripts/set-up.sh PYTHON VENV REQUIREMENT      e.g. scripts/set-up.sh python3 .venv '.[dev]'
set -euo pipefail
cd "$(dirname "$0")/.."
python=$1 venv=$2 requirement=$3
system_libraries="libgl1 libegl1 libgomp1 libusb-1.0-0 libx11-6" # Open3D's wheel links to them

fail() {
    echo "error: $1" >&2
    exit 1
}

. scripts/apt.sh

# Debian's python3 comes without ensurepip, which `python3 -m venv` needs.
make_venv() {
    "$python" -m venv "$venv" >/dev/null 2>&1 && return
    rm -rf "$venv"
    echo "python3 -m venv does not work here; trying to install python3-venv" >&2
    apt_install python3-venv && "$python" -m venv "$venv" && return
    "$python" -m pip --version >/dev/null 2>&1 && "$python" -m venv --without-pip "$venv" &&
        "$python" -m pip --python "$venv/bin/python" install --quiet pip && return
    rm -rf "$venv"
    "$python" -m virtualenv --quiet "$venv" 2>/dev/null && return
    fail "no way to make a virtual environment; run: sudo apt-get install python3-venv"
}

check_open3d() {
    "$venv/bin/python" -c 'import open3d' >/dev/null 2>&1 && return
    echo "Open3D does not load; trying to install the libraries it links to" >&2
    # shellcheck disable=SC2086  # one word a package
    apt_install $system_libraries || true
    "$venv/bin/python" -c 'import open3d' ||
        fail "Open3D does not load; run: sudo apt-get install $system_libraries"
}

command -v "$python" >/dev/null || fail "$python not found; run: sudo apt-get install python3 python3-venv"
"$python" -c 'import sys; sys.exit(not (3, 11) <= sys.version_info[:2] <= (3, 13))' ||
    fail "$("$python" --version) found, 3.11 to 3.13 needed; name another: make PYTHON=python3.12"

[ -x "$venv/bin/python" ] && "$venv/bin/python" -m pip --version >/dev/null 2>&1 || make_venv
pip=("$venv/bin/python" -m pip --disable-pip-version-check)
# Debian 12's pip resolves and unpacks this set four times slower than the pinned one.
"${pip[@]}" install --quiet --no-compile --upgrade --constraint constraints.txt pip
# Compiling every file of every package costs more than compiling the few that are used.
"${pip[@]}" install --quiet --no-compile --constraint constraints.txt \
    --build-constraint constraints.txt --editable "$requirement"
check_open3d
