#!/usr/bin/env python3
"""Checks that the words in the report of scripts/bench --paper follow from the figures."""

import pathlib
import struct
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent.parent
sys.path.insert(0, str(ROOT / "scripts"))

from benchlib import paper_measure, paper_report, paper_text  # noqa: E402


def rule_rows(factor, order=5.0, normal=1.5, models=("cow", "bones")):
    """Rows in which curvature as a factor has `factor` times the rms of the quadrics."""
    values = {"vsplit-quadrics": 1.0, "vsplit-curvature": factor, "vsplit-paper": order,
              "vsplit-normal": normal}
    return [{"model": model, "share": share, "method": method, "rms": value, "max": 2 * value,
             "normals": 10 * value}
            for model in models for share in paper_measure.LEVELS
            for method, value in values.items()]


class Verdict(unittest.TestCase):
    def test_says_that_a_factor_without_effect_hardly_matters(self):
        text = paper_text.verdict(rule_rows(1.01))
        self.assertIn("hardly matters", text)
        self.assertNotIn("It helps on", text)
        self.assertNotIn("It harms on", text)

    def test_says_where_curvature_helps(self):
        text = paper_text.verdict(rule_rows(0.8))
        self.assertIn("curvature helps: 0.80 times", text)
        self.assertIn("cow 50 % (0.80)", text)
        self.assertNotIn("It harms on", text)

    def test_says_where_curvature_harms(self):
        rows = rule_rows(0.8)
        next(row for row in rows if row["model"] == "bones" and row["share"] == 10 and
             row["method"] == "vsplit-curvature")["rms"] = 1.3
        text = paper_text.verdict(rows)
        self.assertIn("It harms on bones 10 % (1.30).", text)
        self.assertIn("curvature harms: 1.20", paper_text.verdict(rule_rows(1.2)))

    def test_judges_the_order_and_the_normal_metric(self):
        text = paper_text.verdict(rule_rows(1.0, order=5.0, normal=1.25))
        self.assertIn("does not work: the rms is 5.0 times", text)
        self.assertIn("rms is 20 % below", text)
        text = paper_text.verdict(rule_rows(1.0, order=1.0, normal=0.8))
        self.assertIn("works: the rms is 1.0 times", text)
        self.assertIn("rms is 25 % above", text)

    def test_leaves_out_levels_that_are_exact(self):
        rows = rule_rows(0.8)
        for row in rows:
            row["rms"] *= 1e-5
        self.assertIn("Too little", paper_text.verdict(rows))


class Words(unittest.TestCase):
    def test_comparison_counts_what_it_lists(self):
        text = paper_text.comparison(rule_rows(0.5), "vsplit-curvature", "vsplit-quadrics")
        self.assertIn("rms 0.50 times", text)
        self.assertIn("more than 5 % lower in 6 of 6: ", text)
        self.assertIn(" and 1 more.", text)
        self.assertTrue(text.endswith("more than 5 % higher in 0 of 6."), text)
        self.assertEqual(
            paper_text.comparison(rule_rows(0.5), "energy", "vsplit-quadrics"), "not measured.")

    def test_regions_compare_levels_of_the_same_size(self):
        rows = []
        for kept in (False, True):
            for vertices in (100, 500):
                rows.append({
                    "model": "cow", "kept": kept, "vertices": vertices, "stream_bytes":
                    vertices * (11 if kept else 10), "vertices_inside": 30 if kept else 10,
                    "inside": 0.2 if kept else 0.4, "outside": 0.3 if kept else 0.2})
        text = paper_text.regions(rows)
        self.assertIn("3.0 times as many", text)
        self.assertIn("0.50 times inside and 1.50 times outside", text)
        self.assertIn("1.100 times the bytes", text)

    def test_frame_rates_are_compared_at_equal_faces(self):
        rows = [{"model": "cow", "metric": metric, "faces": faces, "frames_per_second": rate}
                for metric, scale in (("curvature", 1.0), ("normal", 1.1))
                for faces, rate in ((1000, 10.0 * scale), (500, 20.0 * scale))]
        text = paper_text.frame_rates(rows)
        self.assertIn("2.0 times the original's rate at level 1", text)
        self.assertIn("within 10 % of each other", text)

    def test_streams_are_compared_level_by_level(self):
        rows = [{"model": "cow", "metric": metric, "vertices": vertices, "rms": scale / vertices,
                 "stream_bytes": vertices * (10 if metric == "normal" else 8)}
                for metric, scale in (("curvature", 3.0), ("normal", 2.0)) for vertices in (100, 50)]
        self.assertEqual(
            paper_text.streams(rows),
            "The curvature metric's streams over the normal metric's: 0.80 times the bytes and 1.50 "
            "times the rms as a whole and 0.80 times the bytes and 1.50 times the rms at level 1.")

    def test_ranking_puts_the_best_method_first(self):
        text = paper_text.ranking(rule_rows(2.0), paper_measure.METHODS)
        names = paper_measure.METHODS
        self.assertEqual(text, f"{names['vsplit-quadrics']} 0.50, {names['vsplit-normal']} 0.75 and "
                               f"{names['vsplit-paper']} 2.50")


class Tables(unittest.TestCase):
    def test_rules_have_one_row_for_each_model_and_share(self):
        lines = paper_report.rule_table(rule_rows(0.8)).split("\n")
        self.assertEqual(len(lines), 2 + 2 * len(paper_measure.LEVELS))
        self.assertTrue(lines[-1].endswith("| 0.80 |"), lines[-1])

    def test_methods_that_were_not_run_have_no_row(self):
        rows = [{**row, "faces": 7} for row in rule_rows(0.8, models=("cow",))]
        lines = paper_report.method_table(rows).split("\n")
        self.assertEqual(len(lines), 2 + 4)


class Region(unittest.TestCase):
    def test_holds_a_tenth_of_the_vertices_at_one_end(self):
        points = [(float(i), 0.0, 0.0) for i in range(100)]
        self.assertEqual(paper_measure.end_ball(points), [99.0, 0.0, 0.0, 10.0])

    def test_reads_points_of_both_precisions(self):
        for kind, form in (("double", "<3d"), ("float", "<3f")):
            header = "ply\nformat binary_little_endian 1.0\nelement vertex 2\n" + "".join(
                f"property {kind} {axis}\n" for axis in "xyz") + "end_header\n"
            with tempfile.TemporaryDirectory() as name:
                path = pathlib.Path(name) / "a.ply"
                path.write_bytes(header.encode() + struct.pack(form, 1, 2, 3) +
                                 struct.pack(form, 4, 5, 6))
                self.assertEqual(paper_measure.read_points(path), [(1, 2, 3), (4, 5, 6)])


if __name__ == "__main__":
    unittest.main()
