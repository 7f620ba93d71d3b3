"""report.md: the text around the tables."""

from . import report


def head(results):
    parts = [
        "# vsplit beside its peers",
        "",
        f"{len(results['models'])} meshes, positions and connectivity, 12 bits a coordinate, default "
        f"settings, {report.machine()}. Measured in {results['minutes']:.0f} minutes by `scripts/bench`.",
    ]
    if results["missing"]:
        parts.append(f"\nNot there, and therefore not measured: {', '.join(results['missing'])}.")
    return parts


def rate_part(results):
    models = results["models"]
    sections = [
        "", "## Bytes of the whole stream", "",
        "Draco 1.5.5 as `draco_encoder -cl 10 -qp 12` codes the mesh that the stream decodes to (all "
        "of its vertices, cut copies of non-manifold ones included): both code the same vertices and "
        "triangles on the same grid. bpv: bits per vertex.", "",
        report.size_table(models), "", "## What the first bytes show", "",
        "A prefix is the first ⌊bpv · vertices / 8⌋ bytes of the file, cut off there and decoded. Beside "
        "it the best single level of detail whose Draco file has at most so many bytes, with a free "
        "choice of quantisation (5 to 12 bits) and size (in steps of 1.5 %), for the rms the file with "
        "the least rms; simplifiers start from the unquantised mesh. Nothing is interpolated. Distances "
        f"are symmetric, in percent of the bounding box's diagonal, by {results['judge']}.",
    ]
    titles = [("meshopt", "rms", "rms: vsplit / best meshopt_simplify LOD"),
              ("lindstrom-turk", "rms", "rms: vsplit / best CGAL Lindstrom-Turk LOD"),
              ("meshopt", "max", "Hausdorff distance: vsplit / the same meshopt_simplify LOD")]
    for peer, figure, title in titles:
        sections += ["", f"### {title}", "", report.distance_table(models, peer, figure)]
    sections += ["", "### Points left out of the means", "", report.left_out_list(models)]
    return sections


def write(folder, results):
    """Writes report.md and the CSV files into a folder."""
    lines = [*head(results), "", "## Goals", "", report.goal_table(results["goals"]),
             *rate_part(results)]
    (folder / "report.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    report.write_rate_csv(folder, results["models"])
