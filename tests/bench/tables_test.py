#!/usr/bin/env python3
"""Tests of what scripts/bench computes from its measurements (scripts/benchlib/tables.py, goals.py)."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))

from benchlib import attributes, goals, pictures, tables


def lod(size, rms, largest=1.0):
    return {"bytes": size, "rms": rms, "max": largest, "counts": True}


def model(prefixes, files, vertices=800):
    return {
        "name": "thing", "vertices": vertices, "bytes": 1100, "draco_bytes": 1000, "uncut_bytes": 1000,
        "prefixes": [{"rate": rate, **shown} for rate, shown in prefixes.items()],
        "peers": {"meshopt": files, "lindstrom-turk": files},
    }


class TablesTest(unittest.TestCase):
    def test_geometric_mean_is_the_root_of_the_product(self):
        self.assertAlmostEqual(tables.geometric_mean([2, 8]), 4)
        self.assertAlmostEqual(tables.geometric_mean(iter([0.5, 2.0, 1.0])), 1)
        self.assertIsNone(tables.geometric_mean([]))

    def test_best_file_is_the_best_that_fits_not_the_largest(self):
        files = [lod(100, 0.5), lod(90, 0.2), lod(80, 0.3), lod(101, 0.1)]
        self.assertEqual(tables.best_file(files, 100, "rms"), lod(90, 0.2))
        self.assertEqual(tables.best_file(files, 101, "rms"), lod(101, 0.1))
        self.assertIsNone(tables.best_file(files, 79, "rms"))

    def test_best_file_of_equals_is_the_smallest(self):
        self.assertEqual(tables.best_file([lod(90, 0.2), lod(80, 0.2)], 99, "rms"), lod(80, 0.2))

    def test_envelope_keeps_what_nothing_smaller_betters(self):
        files = [lod(30, 0.4), lod(10, 0.9), lod(20, 0.5), lod(25, 0.6), lod(20, 0.7)]
        self.assertEqual(tables.envelope(files), [lod(10, 0.9), lod(20, 0.5), lod(30, 0.4)])

    def test_point_takes_the_hausdorff_distance_of_the_file_with_the_least_rms(self):
        files = [lod(100, 0.2, 3.0), lod(99, 0.3, 2.0), lod(120, 0.1, 1.0)]
        at_1 = tables.point(model({1: lod(70, 0.1, 6.0)}, files), 1, "meshopt")
        self.assertEqual(at_1["budget"], 100)
        self.assertEqual(tables.ratios([at_1], "rms"), ([0.5], []))
        self.assertEqual(tables.ratios([at_1], "max"), ([2.0], []))
        self.assertEqual(tables.ratios([at_1], "max", "least_max"), ([3.0], []))

    def test_files_that_are_only_drawn_do_not_count(self):
        files = [lod(100, 0.2), dict(lod(90, 0.1), counts=False)]
        at_1 = tables.point(model({1: lod(70, 0.1)}, files), 1, "meshopt")
        self.assertEqual((at_1["file"]["rms"], at_1["least_max"]["rms"]), (0.2, 0.2))

    def test_points_without_a_picture_on_either_side_are_left_out_and_listed(self):
        nothing = {"bytes": None, "rms": None, "max": None}
        shown = model({0.5: nothing, 1: lod(90, 0.3), 2: lod(150, 0.3)}, [lod(110, 0.6)])
        points = [tables.point(shown, rate, "meshopt") for rate in (0.5, 1, 2, 4)]
        values, left_out = tables.ratios(points, "rms")
        self.assertEqual(values, [0.5])
        self.assertEqual([p["rate"] for p in left_out], [0.5, 1, 4])

    def test_verdict_knows_both_directions(self):
        self.assertEqual(tables.verdict(1.1, 1.1, 0.95), "reached")
        self.assertEqual(tables.verdict(0.95, 1.1, 0.95), "stretch")
        self.assertEqual(tables.verdict(1.11, 1.1, 0.95), "short")
        self.assertEqual(tables.verdict(60, 60, 150, larger_is_better=True), "reached")
        self.assertEqual(tables.verdict(59, 60, 150, larger_is_better=True), "short")
        self.assertEqual(tables.verdict(151, 60, 150, larger_is_better=True), "stretch")
        self.assertEqual(tables.verdict(None, 60), "not measured")
        self.assertEqual(tables.verdict(0.0, 1.0), "reached")

    def test_growth_is_the_largest_rise_per_vertex_over_the_smallest_mesh(self):
        rows = [{"vertices": 10, "s": 1.0}, {"vertices": 100, "s": 11.0}, {"vertices": 50, "s": 6.0}]
        self.assertAlmostEqual(tables.growth(rows, "s"), 1.2)
        self.assertIsNone(tables.growth(rows[:1], "s"))

    def test_median_is_the_middle(self):
        self.assertEqual(tables.median([3, 1, 2]), 2)
        self.assertIsNone(tables.median([]))


class GoalsTest(unittest.TestCase):
    def test_size_rows_give_the_mean_and_name_the_worst(self):
        good = dict(model({}, []), name="good", bytes=400, draco_bytes=500)
        bad = dict(model({}, []), name="bad", bytes=1000, draco_bytes=500)
        mean, worst = goals.size_rows([good, bad])
        self.assertAlmostEqual(mean["value"], (0.8 * 2) ** 0.5)
        self.assertEqual(mean["verdict"], "short")
        self.assertEqual((worst["value"], worst["verdict"]), (2.0, "short"))
        self.assertIn("bad", worst["measured"])

    def test_time_and_memory_goals_are_about_the_larger_meshes_and_the_worst_of_them(self):
        def timed(name, vertices, ratio, heap, seconds):
            return dict(
                model({}, [], vertices), name=name,
                decode={"ratio": ratio, "heap_peak_bytes": {"vsplit": heap, "draco": 1}},
                encode={"vertices": vertices, "seconds": seconds, "memory": 1000 * vertices})

        models = [timed("small", 19_999, 9.0, 1e9, 99.0), timed("one", 20_000, 1.5, 1e6, 0.1),
                  timed("two", 40_000, 0.9, 3.2e6, 0.5)]
        ratio, heap = goals.decode_rows(models)
        self.assertEqual((ratio["value"], ratio["verdict"]), (1.5, "reached"))
        self.assertEqual((heap["value"], heap["verdict"]), (80, "reached"))
        speed, memory = goals.encode_rows(models)
        self.assertAlmostEqual(speed["value"], 80)
        self.assertEqual((memory["value"], memory["verdict"]), (1000, "short"))
        self.assertEqual(list(goals.decode_rows(models[:1])), [])

    def test_chunk_rows_name_the_largest(self):
        whole = [{"bytes": 70_000, "vertices": 5, "ends_level": True}]
        models = [dict(model({}, []), name="big", chunks=whole)]
        largest, cutting = goals.chunk_rows(models, None)
        self.assertEqual((largest["value"], largest["verdict"]), (70_000, "short"))
        self.assertAlmostEqual(cutting["value"], 10)
        self.assertEqual(cutting["verdict"], "short")

    def test_distance_rows_count_the_points_left_out(self):
        shown = model({1: lod(90, 0.3, 2.0), 2: lod(190, 0.3, 2.0)}, [lod(90, 0.6, 4.0)])
        rows = list(goals.distance_rows([shown]))
        self.assertTrue(all(row["value"] == 0.5 for row in rows))
        self.assertTrue(all("2 points, 2 left out" in row["measured"] for row in rows))

    def test_attributes_count_where_all_of_a_model_are_coded(self):
        def pair(mine, theirs):
            return {"vsplit": mine, "draco": theirs}

        records = [
            {"name": "a", "added": {"tex_coord": pair(50, 100)}, "all": pair(80, 100),
             "beside": pair(90, 100)},
            {"name": "b", "added": {"tex_coord": pair(200, 100), "normal": pair(0, 100)},
             "all": pair(1, 100), "beside": pair(1, 100)},
        ]
        coordinates, normals, colors, whole, beside = attributes.goal_rows(records)
        self.assertAlmostEqual(coordinates["value"], 1.0)
        self.assertIn("2 of 2", coordinates["measured"])
        self.assertIsNone(normals["value"])
        self.assertIsNone(colors["value"])
        self.assertAlmostEqual(whole["value"], 0.8)
        self.assertAlmostEqual(beside["value"], 0.9)
        self.assertEqual(list(attributes.goal_rows([])), [])

    def test_pictures_are_won_when_at_least_as_good(self):
        def case(mine, theirs):
            return {"budget": 20000, "prefix": {"psnr": mine}, "lod": {"psnr": theirs}}

        first, second, third = pictures.READINGS
        records = [{"name": "a", "cases": {first: [case(30, 29), case(30, 30), case(30, 31)],
                                           second: [case(1, 2)], third: [case(1, 1)]}},
                   {"name": "b", "cases": {first: [case(20, 10), case(20, 11)],
                                           second: [case(1, 2)], third: [case(1, 2)]}}]
        shares = list(pictures.goal_rows(records))
        self.assertEqual([share["value"] for share in shares], [80, 0, 50])
        self.assertEqual([share["verdict"] for share in shares], ["reached", "short", "short"])
        self.assertEqual(list(pictures.goal_rows([])), [])


if __name__ == "__main__":
    unittest.main()
