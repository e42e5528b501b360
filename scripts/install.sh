#!/usr/bin/env bash
# Links this checkout into the Mod folder of the user's FreeCAD.
set -euo pipefail
cd "$(dirname "$0")/.."
mods=$(LANG=C.UTF-8 freecadcmd -c 'import FreeCAD; print("MODS=" + FreeCAD.getUserAppDataDir() + "Mod")' 2>/dev/null </dev/null | sed -n 's/^MODS=//p')
[ -n "$mods" ] || { echo "[install] freecadcmd did not say where its Mod folder is"; exit 1; }
mkdir -p "$mods"
target="$mods/PipeWorkbench"
if [ -e "$target" ] && [ ! -L "$target" ]; then
  echo "[install] $target exists and is not a link; move it away first"; exit 1
fi
ln -sfn "$PWD" "$target"
echo "[install] $target -> $PWD"
echo "[install] start FreeCAD and choose 'Pipe Workbench' in the list of workbenches"
