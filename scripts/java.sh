#!/usr/bin/env bash
# Sees to it that there is a Java for the reasoner, which CI needs and nothing else does.
# usage: scripts/java.sh
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/apt.sh

command -v java >/dev/null && exit
echo "no Java; trying to install one" >&2
apt_install default-jre-headless || true
command -v java >/dev/null || {
    echo "error: no Java; run: sudo apt-get install default-jre-headless" >&2
    exit 1
}
