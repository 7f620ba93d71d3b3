"""What the first bytes of textured models look like, beside the best Draco and JPEG files of those
bytes."""

import tempfile

from . import programs, report
from .cache import content_hash
from .goals import row
from .programs import Run

MODELS = ["spot", "duck", "textured-knot", "african-head", "bunny10k-textured", "damaged-helmet",
          "fuze"]
BUDGETS = [20000, 50000, 100000]
GOAL = 80  # percent of the cases
# The levels of detail may have up to 13 bits a coordinate and 10 a normal, and mostly take them.
OPTIONS = ["--position-bits", "13", "--normal-bits", "10"]
# To be raised when tests/bench/bench_pictures finds other files or measures otherwise than before.
VERSION = 2


def companions(original):
    """The files that a model consists of."""
    return sorted(path for path in original.parent.iterdir() if path.stem == original.stem)


def search(original):
    programs.note(f"looking for the best Draco and JPEG files of {original.stem} (not in the cache)")
    return Run(programs.BENCH_PICTURES, original, "--bytes", ",".join(map(str, BUDGETS))).json()


def measure_model(original, cache, folder):
    key = content_hash("pictures", VERSION, BUDGETS, *companions(original))
    lods = cache.get(key, lambda: search(original))
    programs.note(f"{original.stem}: pictures of prefixes")
    with tempfile.TemporaryDirectory(dir=folder) as place:
        stream = f"{place}/{original.stem}.vsplit"
        Run(programs.VSPLIT, "encode", original, "-o", stream, *OPTIONS).good()
        prefixes = Run(programs.BENCH_PICTURES, original, "--stream", stream, "--bytes",
                       ",".join(map(str, BUDGETS))).json()
    return {"name": original.stem,
            "cases": [{"budget": lod["budget"], "prefix": prefix, "lod": lod}
                      for prefix, lod in zip(prefixes, lods)]}


def measure(originals, cache, folder):
    return [measure_model(original, cache, folder) for original in originals]


def won(case, figure="psnr"):
    return case["prefix"][figure] >= case["lod"][figure]


def goal_rows(records):
    """The row for the table of goals."""
    cases = [case for record in records for case in record["cases"]]
    if cases:
        wins = sum(map(won, cases))
        share = 100 * wins / len(cases)
        yield row("pictures of prefixes that are at least as good as the best Draco and JPEG files",
                  share, f"{share:.0f} % ({wins} of {len(cases)})", GOAL, larger_is_better=True,
                  unit=" %")


def cell(case):
    prefix, lod = case["prefix"], case["lod"]
    mark = "**" if won(case) else ""
    return f"{mark}{prefix['psnr']:.2f}{mark} / {lod['psnr']:.2f}"


def section(records):
    rows = [[record["name"], *map(cell, record["cases"])] for record in records]
    head = ["model", *(f"{budget // 1000} kB" for budget in BUDGETS)]
    return ["", "## What textured models look like", "",
            "PSNR in dB, mean of eight views of 512 by 512 pixels, over the pixels that the original or "
            "what is shown covers: the first bytes of the stream / the best level of detail by "
            "meshopt_simplify and Draco with the image as progressive JPEG, in so many bytes together, "
            "with a free choice of size, quality and bits (up to 13 a coordinate, 10 a normal). Streams "
            "have that many bits and are cut off where the bytes end. Bold where the stream is at least as "
            "good.",
            "", report.table(head, rows)]


def write_csv(folder, records):
    rows = [[record["name"], case["budget"], case["prefix"]["bytes"], case["prefix"]["faces"],
             case["prefix"]["psnr"], case["prefix"]["ssim"], case["lod"]["geometry_bytes"],
             case["lod"]["image_bytes"], case["lod"]["faces"], case["lod"]["side"],
             case["lod"]["quality"], case["lod"]["psnr"], case["lod"]["ssim"]]
            for record in records for case in record["cases"]]
    report.write_csv(folder / "pictures.csv",
                     ["model", "budget", "bytes", "faces", "psnr", "ssim", "lod_geometry_bytes",
                      "lod_image_bytes", "lod_faces", "lod_side", "lod_quality", "lod_psnr",
                      "lod_ssim"], rows)
