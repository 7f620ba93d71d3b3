"""report.md: the text around the tables."""

from . import attributes, pictures, report, speed_report

QUOTED = """## Quoted figures

Not measured here: bits per vertex of the whole mesh at 12 bits, as published in or measured with the
named programs earlier, on the same models.

| | stanford-bunny | horse | rocker-arm | homer | fandisk |
| :-- | --: | --: | --: | --: | --: |
| MEPP2, valence-driven (Lee, Lavoué, Dupont), progressive | 18.8 | 16.8 | 22.8 | 23.1 | 21.6 |
| MEPP2, IPOL 2023 (progressive meshes with Draco's entropy coder) | 24.8 | 22.9 | 27.6 | 27.6 | 30.2 |
| Nexus, levels of detail in one file | 33-44 | | | | |

Their rms in percent at 0.5 / 1 / 2 / 4 bpv, MEPP2 valence with adaptive quantisation: stanford-bunny
.415 / .209 / .117 / .060, rocker-arm 2.2 / .68 / .30 / .156."""


SURFACE_PARTS = {"attributes": attributes, "pictures": pictures}


def surface_sections(results):
    return [line for part, module in SURFACE_PARTS.items() if part in results
            for line in module.section(results[part])]


def head(results):
    parts = [
        "# vsplit beside its peers",
        "",
        f"{len(results['models'])} meshes, positions and connectivity, 12 bits a coordinate, default "
        f"settings, {report.machine()}. Measured in {results['minutes']:.0f} minutes by "
        "`scripts/bench`.",
    ]
    if results["missing"]:
        parts.append(f"\nNot there, and therefore not measured: {', '.join(results['missing'])}.")
    return parts


def rate_section(results):
    models = results["models"]
    if not models:
        return []
    differences = [100 * abs(model["draco_encoder_bytes"] / model["draco_bytes"] - 1)
                   for model in models]
    sections = [
        "", "## Bytes of the whole stream", "",
        "Draco 1.5.5 as `draco_encoder -cl 10 -qp 12` codes the mesh that the stream decodes to (all "
        "of its vertices, cut copies of non-manifold ones included): both code the same vertices and "
        "triangles on the same grid. The program draco_encoder, given the decoded mesh as a file (it "
        f"merges vertices at one place), differs by {max(differences):.2f} % at most. bpv: bits per "
        "vertex.", "",
        *picture(results, "total-bytes", "Total bytes of vsplit divided by Draco's, by model"),
        report.size_table(models), "", "## What the first bytes show", "",
        "A prefix is the first ⌊bpv · vertices / 8⌋ bytes of the file, cut off there and decoded. "
        "Beside it the single level of detail with the least rms whose Draco file has at most so many "
        "bytes, with a free choice of quantisation (5 to 12 bits) and size (in steps of 1.5 %); the "
        "simplifiers start from the mesh before quantisation. Nothing is interpolated. Distances are "
        "symmetric, the larger of both directions, in percent of the bounding box's diagonal, by "
        f"{results['judge']}.", "",
        *picture(results, "rate-distortion", "rms distance over bits per vertex, by model"),
    ]
    titles = [("meshopt", "rms", "rms: vsplit / best meshopt_simplify LOD"),
              ("lindstrom-turk", "rms", "rms: vsplit / best CGAL Lindstrom-Turk LOD"),
              ("meshopt", "max", "Hausdorff distance: vsplit / the same meshopt_simplify LOD")]
    for peer, figure, title in titles:
        sections += ["", f"### {title}", "", report.distance_table(models, peer, figure)]
    sections += ["", "### Points left out of the means", "", report.left_out_list(models)]
    return sections


def picture(results, name, text):
    return [f"![{text}]({name}.png)", ""] if name in results["plots"] else []


def write(folder, results):
    """Writes report.md and the CSV files into a folder."""
    lines = [*head(results), "", "## Goals", "", report.goal_table(results["goals"]),
             *rate_section(results), *surface_sections(results), *speed_report.sections(results), "",
             QUOTED]
    (folder / "report.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    report.write_rate_csv(folder, results["models"])
    speed_report.write_csv(folder, results)
    for part, module in SURFACE_PARTS.items():
        if part in results:
            module.write_csv(folder, results[part])


def update(path, models):
    """Replaces the table between the marks in a document (the README) by a new one."""
    begin, end = "<!-- bench begin -->\n", "<!-- bench end -->"
    before, found, rest = path.read_text(encoding="utf-8").partition(begin)
    _, also_found, after = rest.partition(end)
    if not found or not also_found:
        raise ValueError(f"{path} has no marks for the table")
    path.write_text(f"{before}{begin}{report.summary_table(models)}\n{end}{after}", encoding="utf-8")
