# The project's jobs; each installs what it needs first and can be repeated.
.PHONY: help setup demo test install lint bench docs translations clean
.DEFAULT_GOAL := help
python := .venv/bin/python
results := results

help:  ## list the targets
	@grep -E '^[a-z]+:.*##' $(MAKEFILE_LIST) | sed 's/:.*## /\t/' | expand -t 14

setup:  ## install FreeCAD (Debian) and the Python packages where they are missing
	@bash scripts/setup.sh

demo: setup  ## reconstruct and insulate the bundled sample and say where the results are
	@mkdir -p $(results)
	$(python) -m pipeworkbench reconstruct resources/samples/dummy/A \
	  --out $(results)/dummy.json --out $(results)/dummy.csv --out $(results)/dummy.png \
	  --out $(results)/dummy.ifc --out $(results)/dummy.step --out $(results)/dummy.FCStd
	$(python) -m pipeworkbench insulate $(results)/dummy.json --thickness 30 --medium 90 \
	  --out $(results)/dummy_insulation.pdf --out $(results)/dummy_insulation.dxf --out $(results)/dummy_insulation.step --out $(results)/dummy_insulation.xlsx
	@echo "The results are in $(abspath $(results)): look at dummy.png first, and at dummy_insulation.pdf; then make install, and open dummy.FCStd in FreeCAD."

test: setup  ## run every test: plain, inside FreeCAD, inside FreeCAD's window
	@bash scripts/test.sh

lint: setup  ## ruff, mypy and the import rules
	.venv/bin/ruff check .
	.venv/bin/ruff format --check .
	.venv/bin/mypy
	.venv/bin/lint-imports

install: setup  ## link the addon into FreeCAD's Mod folder
	@bash scripts/install.sh

bench: setup  ## accuracy and time of the steps, beside peers where these are to be had
	-$(python) -m pip install -q --disable-pip-version-check -c requirements/freecad-debian12.txt -e '.[bench]'
	$(python) bench/measuring.py
	$(python) bench/reconstruct.py
	$(python) bench/recompute.py
	$(python) bench/ifc.py
	$(python) bench/insulating.py $(if $(wildcard ../shared),../shared)
	[ ! -d ../shared ] || $(python) bench/elbows_flanges.py ../shared --out $(results)/elbows_flanges.md
	[ ! -d ../shared ] || $(python) bench/adjust.py ../shared --out $(results)/adjust.md
	$(python) bench/register.py

docs: setup  ## write the reference of the reconstruction modules to build/docs
	$(python) -m pip install -q --disable-pip-version-check -c requirements/freecad-debian12.txt -e '.[docs]'
	$(python) -m pdoc -o build/docs pipeworkbench.pipeline pipeworkbench.catalogue pipeworkbench.solids pipeworkbench.recon pipeworkbench.exports

translations: setup  ## collect the window's texts and compile their translations
	$(python) scripts/translations.py

clean:  ## remove the environment and everything that was made
	rm -rf .venv build dist $(results)
