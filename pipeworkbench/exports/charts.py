# SPDX-License-Identifier: LGPL-2.1-or-later
"""Charts of a report, as SVG that stands in the page itself."""

from __future__ import annotations

import io
import math
from collections import Counter
from collections.abc import Sequence
from typing import Any

import numpy as np

from pipeworkbench.errors import MissingPackageError
from pipeworkbench.exports.texts import Texts
from pipeworkbench.pipeline import Pipeline
from pipeworkbench.recon.accuracy import LEVELS_OF_ACCURACY

SIZE_INCHES = (4.2, 2.6)
COLOUR, EDGE = "#009e73", "#ffffff"
MOST_BINS = 20
LEVELS = [name for _, name in LEVELS_OF_ACCURACY] + ["LOA10"]


def accuracy_charts(pipeline: Pipeline, texts: Texts) -> list[Any]:
    """Return charts, as markup, of what is known of the components' accuracy: standard deviations, fits, levels of accuracy.

    Raises
    ------
    MissingPackageError
        Where matplotlib or jinja2 is not installed.
    """
    components = pipeline.components
    sigmas = [math.hypot(*component.sigma_position) for component in components if component.sigma_position is not None]
    qualities = [component.quality for component in components if component.quality is not None]
    levels = Counter(component.loa for component in components if component.loa)
    charts = [_histogram(values, texts[title], texts) for values, title in ((sigmas, "chart_sigma"), (qualities, "chart_quality")) if values]
    if levels:
        charts.append(_bars(LEVELS, [levels[name] for name in LEVELS], texts["chart_loa"], texts))
    return charts


def _histogram(values: Sequence[float], title: str, texts: Texts) -> Any:
    figure, axes = _axes(title, texts)
    bins = min(MOST_BINS, max(5, 2 * math.ceil(math.sqrt(len(values)))))
    axes.locator_params(axis="x", nbins=6)
    axes.hist(values, bins=bins, range=(0.0, float(np.max(values)) * 1.02 or 1.0), color=COLOUR, edgecolor=EDGE)
    return _markup(figure)


def _bars(names: Sequence[str], counts: Sequence[int], title: str, texts: Texts) -> Any:
    figure, axes = _axes(title, texts)
    axes.bar(names, counts, color=COLOUR, edgecolor=EDGE)
    return _markup(figure)


def _axes(title: str, texts: Texts) -> tuple[Any, Any]:
    try:
        # the figure alone: nothing of a window is loaded
        from matplotlib.figure import Figure
        from matplotlib.ticker import MaxNLocator
    except ImportError:
        raise MissingPackageError("matplotlib", "Writing a report", "pip install 'matplotlib>=3.6,<4'") from None
    figure = Figure(figsize=SIZE_INCHES, layout="constrained")
    axes = figure.add_subplot()
    axes.set_xlabel(title, fontsize=9)
    axes.set_ylabel(texts["chart_count"], fontsize=9)
    axes.tick_params(labelsize=8)
    axes.yaxis.set_major_locator(MaxNLocator(integer=True))
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    return figure, axes


def _markup(figure: Any) -> Any:
    from markupsafe import Markup
    from matplotlib import rc_context

    buffer = io.StringIO()
    # texts stay texts: the page's font, a tenth of the size; the same figures give the same file
    with rc_context({"svg.fonttype": "none", "svg.hashsalt": "pipeworkbench"}):
        figure.savefig(buffer, format="svg", metadata={"Date": None})
    text = buffer.getvalue()
    return Markup(text[text.index("<svg") :])  # noqa: S704  # drawn here, from numbers and the report's own texts
