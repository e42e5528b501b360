#!/usr/bin/env bash
# Runs every test: plain pytest, inside FreeCAD without a window, inside FreeCAD's window under Xvfb.
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
export LANG=C.UTF-8 PYTHONDONTWRITEBYTECODE=1
site=$(.venv/bin/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))')

say() { printf '\n[test] %s\n' "$*"; }
failed=0

say "web-ifc, which reads IFC independently"
bash scripts/web_ifc/install.sh

say "plain pytest, two at a time"
.venv/bin/python -m pytest -q -n 2 "$@" || failed=1

# FreeCAD swallows exceptions and exits with 0: the verdict is what the tests wrote into a file, and a
# traceback in its log is a failure whatever they say, but for the errors that objects report to the
# user: FreeCAD shows these as tracebacks that end in our own InputError
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
verdict() { # name
  local code
  code=$(cat "$work/$1.exit" 2>/dev/null || echo "FreeCAD ended without a verdict")
  if [ "$code" != 0 ]; then echo "[test] $1 failed: $code"; failed=1; fi
  local tracebacks reported
  tracebacks=$(grep -c '^Traceback' "$work/$1.log" || true)
  reported=$(grep -c "^<class 'pipeworkbench.errors.InputError'>" "$work/$1.log" || true)
  if [ "$tracebacks" -gt "$reported" ]; then
    echo "[test] $1: FreeCAD's log has $((tracebacks - reported)) unexpected tracebacks"; failed=1
  fi
}

# a home of its own: neither the user's settings nor what earlier runs left behind
export HOME="$work/home"
mkdir -p "$HOME"
export PYTHONPATH="$root:$site"

say "inside FreeCAD, without a window"
PIPEWORKBENCH_TESTS="$root/tests/freecad" PIPEWORKBENCH_EXIT="$work/freecad.exit" \
  timeout 1200 freecadcmd "$root/tests/run_in_freecad.py" >"$work/freecad.log" 2>&1 || true
cat "$work/freecad.log"; verdict freecad

say "inside FreeCAD's window under Xvfb"
mods=$(freecadcmd -c 'import FreeCAD; print("MODS=" + FreeCAD.getUserAppDataDir() + "Mod")' 2>/dev/null </dev/null | sed -n 's/^MODS=//p')
mkdir -p "$mods"
ln -sfn "$root" "$mods/PipeWorkbench"
cp tests/gui/user.cfg "$work/user.cfg"
PIPEWORKBENCH_TESTS="$root/tests/gui" PIPEWORKBENCH_EXIT="$work/gui.exit" QTWEBENGINE_DISABLE_SANDBOX=1 \
  timeout 1200 xvfb-run -a -s "-screen 0 1600x1000x24" \
  freecad -u "$work/user.cfg" "$root/tests/run_in_freecad.py" >"$work/gui.log" 2>&1 || true
cat "$work/gui.log"; verdict gui

if [ $failed -ne 0 ]; then say "FAILED"; exit 1; fi
say "all tests passed"
