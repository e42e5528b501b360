#!/usr/bin/env bash
# Installs the npm package web-ifc beside read.cjs, for the tests that read IFC with a program independent of ifcopenshell.
# Without npm these tests are skipped; in CI npm is installed, too. Safe to run again.
set -euo pipefail
cd "$(dirname "$0")"
say() { printf '[web-ifc] %s\n' "$*"; }

wanted=$(sed -n 's/.*"web-ifc": "\([^"]*\)".*/\1/p' package.json)
if [ "$(sed -n 's/^  "version": "\([^"]*\)".*/\1/p' node_modules/web-ifc/package.json 2>/dev/null)" = "$wanted" ] && command -v node >/dev/null; then
  say "$wanted is there"
  exit 0
fi
if ! command -v npm >/dev/null && [ "${CI:-}" = true ] && command -v apt-get >/dev/null && [ "$(id -u)" -eq 0 ]; then
  say "installing Debian packages: nodejs npm (a minute or two)"
  { apt-get update -q && DEBIAN_FRONTEND=noninteractive apt-get install -qy --no-install-recommends nodejs npm; } >/dev/null 2>&1 || true
fi
if ! command -v npm >/dev/null; then
  say "npm is not installed: the tests with web-ifc are skipped (apt-get install nodejs npm)"
  exit 0
fi
say "installing $wanted"
npm install --silent --no-audit --no-fund --no-package-lock >/dev/null 2>&1 || say "npm install failed: the tests with web-ifc are skipped"
