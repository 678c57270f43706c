"""A run and its analysis as arrays and tables: the numbers of the files, in the shapes and units that are said."""
import csv
import re
import unittest

from support import FolderTest, needs_package

try:
    import h5py
    import numpy

    import millscope
    from millscope.units import suffix, with_unit
except ImportError:
    pass


@needs_package
class Units(unittest.TestCase):
    def test_names_end_with_their_unit(self):
        for unit, end in (("m", "m"), ("m/s", "m_per_s"), ("N m", "N_m"), ("m^2/s^2", "m2_per_s2"), ("1/s", "per_s"), ("W/kg", "W_per_kg"), ("%", "percent"),
                          ("rad/s", "rad_per_s"), ("1", ""), ("", "")):
            self.assertEqual(suffix(unit), end, unit)
        self.assertEqual((with_unit("speed", "m/s"), with_unit("share", "1"), with_unit("x_percent", "%")), ("speed_m_per_s", "share", "x_percent"))


@needs_package
class Reading(FolderTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.run_ = millscope.run(cls.folder / "case.yaml", cls.folder / "out", settings=cls.SMALL, progress=False)
        cls.analysis = millscope.analyze(cls.run_, cls.folder / "maps", pictures=False, progress=False)

    def test_frames(self):
        frames = self.run_.frames
        with h5py.File(self.folder / "out/frames.h5") as file:
            time, position, velocity, names = file["time"][:], file["position"][:], file["velocity"][:], file["beads/material"].attrs["names"]
            work, radius, impacts = file["wall_work"][:], file["beads/radius"][:], file["impacts"][-1]
        self.assertEqual((len(frames), frames.position_m.shape), (len(time), position.shape))
        self.assertEqual((frames.position_m.unit, frames.velocity_m_per_s.unit, frames.spin_rad_per_s.unit), ("m", "m/s", "rad/s"))
        numpy.testing.assert_array_equal(frames.time_s, time)
        for index in (-1, 0, slice(2, 5), slice(None, None, -7), [1, 3], (-1, 5), (slice(1, 4), slice(None), 0), (3, slice(None), slice(0, 2)), slice(4, 4),
                      (..., 0), ..., (slice(0, 3), [1, 2, 3]), (slice(0, 5), numpy.arange(position.shape[1]) == 4), ([0, 2], [1, 5]), (3, [1, 5]),
                      (slice(8, 2, -2), ..., 1), (numpy.arange(len(time)) % 3 == 0, ..., 0), (None, 2), (slice(2, 4), None, 3)):
            numpy.testing.assert_array_equal(frames.position_m[index], position[index], str(index))
        numpy.testing.assert_array_equal(numpy.asarray(frames.velocity_m_per_s), velocity)
        with self.assertRaises(IndexError):
            frames.position_m[len(time)]
        self.assertEqual(frames.beads["material"].tolist(), [names[0]] * len(radius))
        numpy.testing.assert_array_equal(frames.beads["radius_m"], radius)
        self.assertEqual(frames.wall_work.columns.tolist(), ["liner_J"])
        numpy.testing.assert_array_equal(frames.wall_work.to_numpy(), work)
        self.assertEqual(frames.wall_work.index.name, "time_s")
        self.assertTrue(all(name.endswith("_J") for name in frames.dissipation))
        self.assertEqual(frames.impacts().iloc[:, 2:].to_numpy().sum(), impacts.sum())

    def test_summary_series_case_and_doubts(self):
        run = self.run_
        self.assertEqual(run.power.loc["com", "power_W"], run.summary["power_W"]["com"])
        self.assertEqual(run.power.loc["torque", "sem_W"], run.summary["power_W"]["torque_sem"])
        self.assertEqual(run.series.columns[0], "time_s")
        with open(self.folder / "out/series.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        numpy.testing.assert_array_equal(run.series["power_com_W"], [float(row["power_com_W"]) for row in rows])
        inside = run.series["time_s"].between(*run.summary["window_s"])
        self.assertAlmostEqual(run.series["power_com_W"][inside].mean(), run.power.loc["com", "power_W"], delta=0.02 * run.power.loc["com", "power_W"])
        self.assertEqual(run.case["time"]["end_s"], 1.2)
        self.assertEqual(len(run.doubts), len(run.summary["doubts"]))
        self.assertIn("short_window", set(run.doubts["name"]))

    def test_tracks(self):
        tracks = self.run_.tracks
        self.assertEqual(len(tracks), 2)
        name, track = next(iter(tracks.items()))
        self.assertEqual((track.bead, track.source, track.diameter_m), (int(name.split("_")[1]), "simulation", 0.005))
        self.assertEqual(track.position_m.shape, (len(track.time_s), 3))
        self.assertTrue((numpy.diff(track.time_s) > 0).all())
        table = tracks.table()
        self.assertEqual(table.columns.tolist(), ["track", "time_s", "x_m", "y_m", "z_m"])
        numpy.testing.assert_array_equal(table[table["track"] == name][["x_m", "y_m", "z_m"]], track.position_m)
        self.assertNotIn("bead_x", tracks)
        self.assertIsNone(tracks.get("bead_x"))
        with self.assertRaisesRegex(millscope.Error, "there is no track 'bead_x'; there are: bead_"):
            tracks["bead_x"]

    def test_results_are_those_of_the_tables(self):
        with open(self.folder / "maps/tables/numbers.csv", newline="") as file:
            rows = {f"{row['analyzer']}.{row['name']}": row for row in csv.DictReader(file)}
        numbers = self.analysis.numbers()
        self.assertEqual(set(rows), set(numbers.index))
        for name, row in rows.items():
            self.assertEqual(numbers.loc[name, "unit"], row["unit"], name)
            self.assertEqual(set(filter(None, numbers.loc[name, "doubts"].split(", "))), set(filter(None, re.split(", |; ", row["doubts"]))), name)
            for ours, theirs in (("value", "value"), ("sem", "sem"), ("low", "low_90"), ("high", "high_90")):
                numpy.testing.assert_equal(numbers.loc[name, ours], float(row[theirs] or "nan"), f"{name} {ours}")

    def test_a_map_as_table(self):
        speed = self.analysis["pept_grid.speed"]
        self.assertEqual((speed.unit, speed.value.shape, [axis.name for axis in speed.axes]), ("m/s", (50, 50), ["pept_grid.y_edges", "pept_grid.x_edges"]))
        table = speed.table()
        self.assertEqual(table.columns.tolist(), ["y_from_m", "y_to_m", "x_from_m", "x_to_m", "speed_m_per_s", "speed_sem_m_per_s", "speed_low_m_per_s", "speed_high_m_per_s"])
        with open(self.folder / "maps/tables/pept_grid.y_edges.x_edges.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), len(table))
        numpy.testing.assert_array_equal(table["speed_m_per_s"], [float(row["speed [m/s]"] or "nan") for row in rows])
        numpy.testing.assert_array_equal(table["x_to_m"], [float(row["x_edges_to [m]"]) for row in rows])

    def test_curves_on_edges_and_on_counts(self):
        self.assertEqual(self.analysis["distributions.x_percent"].table().columns.tolist(), ["x_from_m", "x_to_m", "x_percent", "x_sem_percent", "x_low_percent", "x_high_percent"])
        self.assertEqual(self.analysis["distributions.x_cumulative"].table().columns[0], "x_m")
        self.assertEqual(self.analysis["free_flight.gravity"].table().columns[0], "index_0")
        self.assertEqual(len(self.analysis["power.power_gravity"].table()), 1)
        self.assertIsNone(self.analysis["pept_grid.x_edges"].sem)

    def test_draws_and_covariance_hang_together(self):
        gravity = self.analysis["power.power_gravity"]
        self.assertAlmostEqual(gravity.draws.std() / float(gravity.sem), 1, delta=0.5)
        covariance = self.analysis.covariance()
        self.assertAlmostEqual(covariance.loc["power.power_gravity", "power.power_gravity"] / gravity.draws.var(ddof=1), 1, delta=1e-3)
        with self.assertRaisesRegex(millscope.Error, "has no draws"):
            self.analysis["pept_grid.x_edges"].draws

    def test_names_that_are_not_there(self):
        with self.assertRaisesRegex(millscope.Error, r"there is no result 'power\.gravity'; near it: power\."):
            self.analysis["power.gravity"]
        self.assertIsNone(self.analysis.get("power.gravity"))
        self.assertIn("power.power_gravity", self.analysis)
        self.assertTrue(any("blocks" in note for note in self.analysis.notes))

    def test_wrong_files_are_refused_in_one_line(self):
        for opened, path, line in ((millscope.open_run, self.folder, "is no directory of a run"), (millscope.open_run, self.folder / "no", "it comes from: millscope run"),
                                   (millscope.open_tracks, self.folder / "out/frames.h5", "its format is 'millscope frames', not 'millscope tracks'"),
                                   (millscope.open_tracks, self.folder / "out/series.csv", "cannot be opened as HDF5"),
                                   (millscope.open_analysis, self.folder / "out", "there is no .*results.h5")):
            with self.subTest(line), self.assertRaisesRegex(millscope.Error, line) as caught:
                opened(path)
            self.assertNotIn("\n", str(caught.exception))

    def test_another_version_is_refused(self):
        path = self.folder / "later.h5"
        path.write_bytes((self.folder / "maps/results.h5").read_bytes())
        with h5py.File(path, "a") as file:
            file.attrs["schema_version"] = 3
        with self.assertRaisesRegex(millscope.Error, "is of schema version 3, this package reads 2"):
            millscope.open_analysis(path)


if __name__ == "__main__":
    unittest.main()
