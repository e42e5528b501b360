#!/usr/bin/env bash
# Installs what is missing: FreeCAD and its helpers from Debian's packages, .venv from the system's python3.
# Safe to run again: it does nothing that is done already.
set -euo pipefail
cd "$(dirname "$0")/.."

packages=(freecad python3-venv python3-pyside2.qttest xvfb xauth)
say() { printf '[setup] %s\n' "$*"; }

missing=()
for package in "${packages[@]}"; do
  [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)" = installed ] || missing+=("$package")
done
if [ ${#missing[@]} -gt 0 ]; then
  command -v apt-get >/dev/null || { say "needs ${missing[*]}: install FreeCAD and Xvfb with your system's package manager"; exit 1; }
  as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { say "run as root: apt-get install --no-install-recommends ${missing[*]}"; exit 1; }
    as_root=(sudo)
  fi
  say "installing Debian packages: ${missing[*]} (about a minute)"
  log=$(mktemp)
  if ! { "${as_root[@]}" apt-get update -q && "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
         apt-get install -qy --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
    tail -n 20 "$log"; say "apt-get failed; its full output is in $log"; exit 1
  fi
  rm -f "$log"
else
  say "Debian packages: all there"
fi

# FreeCAD uses the system's Python: an environment of another one would not fit its modules
python=/usr/bin/python3
stamp=.venv/.installed
wanted=$(cat pyproject.toml requirements/freecad-debian12.txt | sha256sum | cut -d' ' -f1)
if [ "$(cat "$stamp" 2>/dev/null || true)" = "$wanted" ] && .venv/bin/python -c 'import pipeworkbench' 2>/dev/null; then
  say "Python packages: all there (.venv)"
else
  say "installing Python packages into .venv (one to two minutes)"
  [ -x .venv/bin/python ] || "$python" -m venv --system-site-packages .venv
  .venv/bin/python -m pip install -q --disable-pip-version-check -c requirements/freecad-debian12.txt -e '.[test,lint]'
  printf '%s\n' "$wanted" >"$stamp"
fi
