#!/usr/bin/env bash
# Sees to it that there is a Chromium for the page's tests, which CI needs and nothing else does.
# usage: scripts/chromium.sh
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/apt.sh

found() { command -v chromium || command -v chromium-browser; } >/dev/null
found && exit
echo "no Chromium; trying to install one" >&2
apt_install chromium || true
found || {
    echo "error: no Chromium; run: sudo apt-get install chromium" >&2
    exit 1
}
