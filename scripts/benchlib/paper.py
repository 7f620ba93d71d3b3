"""scripts/bench --paper: the paper's tables and figure, the methods it cites, and where curvature
helps."""

import pathlib
import tempfile

from . import models, paper_measure, paper_report, programs
from . import paper_programs as run
from .programs import note


def measure_rules(named, folder, judge, known):
    """The rules on more models than the paper's, as far as the folder of models has them."""
    source = models.models_folder(named)
    rows = []
    for name in paper_measure.RULE_MODELS:
        if name in known:
            rows += [row for row in known[name] if row["method"] in paper_measure.RULES]
            continue
        path = models.find_model(source, name)
        if path:
            note(f"{name}: rules")
            model = paper_measure.prepare(path, folder)
            rows += paper_measure.measure_methods(model, paper_measure.RULES, folder, judge)
    return rows


def measure(named, folder):
    judge = run.PaperJudge(programs.BUILD / "cache")
    results = {"judge": judge, "models": [], "streams": [], "methods": [], "regions": []}
    by_model = {}
    for path in run.find_paper_models(named):
        model = paper_measure.prepare(path, folder)
        results["models"].append(model)
        note(f"{model.name}: streams")
        results["streams"] += paper_measure.measure_streams(model, folder, judge)
        note(f"{model.name}: methods")
        by_model[model.name] = paper_measure.measure_methods(model, paper_measure.METHODS, folder, judge)
        results["methods"] += by_model[model.name]
        note(f"{model.name}: regions")
        results["regions"] += paper_measure.measure_regions(model, folder)
    results["rules"] = measure_rules(named, folder, judge, by_model)
    return results


def main(named, output):
    """Measures and writes paper.md, CSV files and contact sheets. `named`: folder of meshes or None."""
    run.build()
    output = pathlib.Path(output)
    output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="vsplit-paper-") as name:
        folder = pathlib.Path(name)
        paper_report.write(output, folder, measure(named, folder))
    note(f"wrote {output}/paper.md")
    return 0
