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
# Which bits of positions, texture coordinates and normals: what streams are encoded with, what levels of
# detail may have at most. The first one is what a publisher gets beside peers with the bits of the figures.
LOW = ["--position-bits", "12", "--uv-bits", "10", "--normal-bits", "8"]
HIGH = ["--position-bits", "14", "--uv-bits", "13", "--normal-bits", "10"]
READINGS = {
    "as encoded by default, peers of up to 12, 10 and 8 bits": ([], LOW),
    "both of up to 12, 10 and 8 bits": (LOW, LOW),
    "both of up to 14, 13 and 10 bits": (HIGH, HIGH),
}
# To be raised when tests/bench/bench_pictures finds other files or measures otherwise than before.
VERSION = 3


def companions(original):
    """The files that a model consists of."""
    return sorted(path for path in original.parent.iterdir() if path.stem == original.stem)


def in_bytes():
    return ["--bytes", ",".join(map(str, BUDGETS))]


def search(original, most):
    programs.note(f"looking for the best Draco and JPEG files of {original.stem} (not in the cache)")
    return Run(programs.BENCH_PICTURES, original, *in_bytes(), *most).json()


def measure_reading(original, options, most, cache, folder):
    key = content_hash("pictures", VERSION, BUDGETS, most, *companions(original))
    lods = cache.get(key, lambda: search(original, most))
    with tempfile.TemporaryDirectory(dir=folder) as place:
        stream = f"{place}/{original.stem}.vsplit"
        Run(programs.VSPLIT, "encode", original, "-o", stream, *options).good()
        prefixes = Run(programs.BENCH_PICTURES, original, "--stream", stream, *in_bytes()).json()
    return [{"budget": lod["budget"], "prefix": prefix, "lod": lod}
            for prefix, lod in zip(prefixes, lods)]


def measure_model(original, cache, folder):
    programs.note(f"{original.stem}: pictures of prefixes")
    return {"name": original.stem,
            "cases": {reading: measure_reading(original, options, most, cache, folder)
                      for reading, (options, most) in READINGS.items()}}


def measure(originals, cache, folder):
    return [measure_model(original, cache, folder) for original in originals]


def won(case, figure="psnr"):
    return case["prefix"][figure] >= case["lod"][figure]


def goal_rows(records):
    """The rows for the table of goals, one a reading."""
    for reading in READINGS if records else []:
        cases = [case for record in records for case in record["cases"][reading]]
        wins = sum(map(won, cases))
        share = 100 * wins / len(cases)
        yield row("pictures of prefixes that are at least as good as the best Draco and JPEG files, "
                  + reading, share, f"{share:.0f} % ({wins} of {len(cases)})", GOAL,
                  larger_is_better=True, unit=" %")


def cell(case):
    prefix, lod = case["prefix"], case["lod"]
    mark = "**" if won(case) else ""
    return f"{mark}{prefix['psnr']:.2f}{mark} / {lod['psnr']:.2f}"


def section(records):
    head = ["model", *(f"{budget // 1000} kB" for budget in BUDGETS)]
    lines = ["", "## What textured models look like", "",
             "PSNR in dB, mean of eight views of 512 by 512 pixels, over the pixels that the original or "
             "what is shown covers: the first bytes of the stream / the best level of detail by "
             "meshopt_simplify and Draco with the image as progressive JPEG, in so many bytes together, "
             "with a free choice of size, quality and bits up to those that the table tells. Streams are "
             "cut off where the bytes end. Bold where the stream is at least as good."]
    for reading in READINGS:
        rows = [[record["name"], *map(cell, record["cases"][reading])] for record in records]
        lines += ["", f"Bits of positions, texture coordinates and normals: {reading}.", "",
                  report.table(head, rows)]
    return lines


def write_csv(folder, records):
    rows = [[record["name"], reading, case["budget"], case["prefix"]["bytes"],
             case["prefix"]["faces"], case["prefix"]["psnr"], case["prefix"]["ssim"],
             case["lod"]["geometry_bytes"], case["lod"]["image_bytes"], case["lod"]["faces"],
             case["lod"]["side"], case["lod"]["quality"], case["lod"]["psnr"], case["lod"]["ssim"]]
            for record in records for reading, cases in record["cases"].items() for case in cases]
    report.write_csv(folder / "pictures.csv",
                     ["model", "bits", "budget", "bytes", "faces", "psnr", "ssim",
                      "lod_geometry_bytes", "lod_image_bytes", "lod_faces", "lod_side", "lod_quality",
                      "lod_psnr", "lod_ssim"], rows)
