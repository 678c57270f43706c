"""Recordings to and from pept, and files of up4."""
import types
import unittest

from support import FolderTest, needs_package

try:
    import h5py
    import numpy
    import pandas

    import millscope
except ImportError:
    pass

COLUMNS = ["time_s", "x_m", "y_m", "z_m"]


def circle(seed, count=1500):
    """Points of pept [n, 5], ms and mm: a bead on a rotor of 100 mm, 0.3 mm off, every 5 ms; error last."""
    random, t = numpy.random.default_rng(seed), numpy.arange(count) * 5.0
    return numpy.column_stack([t, 100 * numpy.cos(t / 300), 100 * numpy.sin(t / 300), numpy.full(count, 10.0), numpy.full(count, 1.5)]) + numpy.column_stack(
        [numpy.zeros(count), random.normal(scale=0.3, size=(count, 3)), random.uniform(0, 0.5, count)])


@needs_package
class Pept(FolderTest):
    def labelled(self):
        """Two beads as pept has them: a column label behind the error."""
        return numpy.vstack([numpy.column_stack([circle(seed), numpy.full(1500, float(seed))]) for seed in (0, 1)])

    def test_a_table_of_pept_and_back(self):
        points = types.SimpleNamespace(points=self.labelled(), columns=["t", "x", "y", "z", "error", "label"])  # as a pept.PointData
        recording = millscope.from_pept(points)
        self.assertEqual(len(recording), 2)
        self.assertEqual(sum(recording.set_aside.values()), 0)
        table = millscope.to_pept(recording, error_mm=1.5)
        self.assertEqual(table.columns.tolist(), points.columns)
        self.assertEqual(table.attrs["units"], {"t": "ms", "x": "mm", "y": "mm", "z": "mm", "error": "mm", "label": "1"})
        numpy.testing.assert_allclose(table[["t", "x", "y", "z", "label"]].to_numpy(), points.points[:, [0, 1, 2, 3, 5]], rtol=1e-14, atol=1e-12)

    def test_a_file_of_pept_and_back(self):
        # What pept.PointData.to_csv writes: numpy.savetxt below a comment with the columns.
        numpy.savetxt(self.folder / "theirs.csv", self.labelled(), delimiter=" ", header="t x y z error label")
        recording = millscope.open_recording(self.folder / "theirs.csv")
        self.assertEqual([len(track.time_s) for track in recording.values()], [1500, 1500])
        ours = millscope.write_pept(recording, self.folder / "ours.csv", error_mm=2)
        self.assertEqual(ours.read_text().splitlines()[0], "# t x y z error label")
        read = pandas.read_csv(ours, skiprows=1, sep=r"\s+", header=None, dtype=float).to_numpy()  # as pept.read_csv(path, skiprows=1)
        self.assertEqual(read.shape, (3000, 6))
        again = millscope.open_recording(ours)
        numpy.testing.assert_allclose(again.table()[COLUMNS].to_numpy(), recording.table()[COLUMNS].to_numpy(), rtol=1e-14, atol=1e-15)
        with self.assertRaisesRegex(millscope.Error, "is there already"):
            millscope.write_pept(recording, ours)

    def test_rows_that_are_not_used_are_counted(self):
        points = circle(3)
        points[700, 1:4] = [4000, 4000, 4000]
        points[701] = points[702]
        recording = millscope.from_pept(points, ["t", "x", "y", "z", "error"])
        self.assertEqual(sum(len(track.time_s) for track in recording.values()), 1498)
        self.assertEqual({rule: rows for rule, rows in recording.set_aside.items() if rows}, {"duplicates": 1, "outside": 1})

    def test_an_error_that_is_unknown_costs_no_row(self):
        points = circle(4)
        points[5:, 4] = numpy.nan
        self.assertEqual(len(millscope.from_pept(points, ["t", "x", "y", "z", "error"]).table()), 1500)

    def test_refusals(self):
        for points, columns, line in ((circle(0), ["t", "x", "y", "error", "z2"], "have no column z"), (circle(0), ["t", "x"], "one name for each column"),
                                      (circle(0)[:3], ["t", "x", "y", "z", "error"], "the points")):
            with self.subTest(line), self.assertRaisesRegex(millscope.Error, line) as caught:
                millscope.from_pept(points, columns)
            self.assertNotIn("/tmp", str(caught.exception))

    def test_a_recording_from_memory_has_no_file_to_analyze(self):
        recording = millscope.from_pept(circle(0), ["t", "x", "y", "z", "error"])
        with self.assertRaisesRegex(millscope.Error, "write it with write_pept"):
            millscope.analyze(recording, self.folder / "nothing")


@needs_package
class Up4(FolderTest):
    """The layout as up4's own reader asks for it (src/datamanager/tdata.rs, pdata.rs): names, shapes, types."""

    def test_frames_of_a_run(self):
        run = millscope.run(self.folder / "case.yaml", self.folder / "out", settings={**self.SMALL, "time.end_s": 0.2, "time.analyze_from_s": 0.1}, progress=False)
        path = millscope.write_up4(run, self.folder / "run.hdf5", every=4)
        frames = run.frames
        count, beads = len(range(0, len(frames), 4)), len(frames.beads)
        with h5py.File(path) as file:
            self.assertEqual((file.attrs["hdf5_up4_type"], file.attrs["timesteps"], file.attrs["particle number"]), (1, count, beads))
            self.assertEqual({name: numpy.shape(file.attrs[name]) for name in ("dimensions", "time", "velocity", "velocity magnitude", "sample rate")},
                             {"dimensions": (2, 3), "time": (2,), "velocity": (3, 3), "velocity magnitude": (3,), "sample rate": ()})
            numpy.testing.assert_array_equal(file["time array"][:], frames.time_s[::4])
            velocity = []
            for k in range(count):
                group = file[f"timestep {k}"]
                self.assertEqual(group["time"][()], frames.time_s[4 * k])
                for name in ("id", "radius", "density", "particletype", "ppcloud"):
                    self.assertEqual((group[name].shape, group[name].dtype), ((beads,), numpy.float64), name)
                self.assertEqual((group["position"].dtype, group["velocity"].dtype), (numpy.float64, numpy.float64))
                order = frames.beads["id"].to_numpy().argsort()
                numpy.testing.assert_array_equal(group["position"][:], frames.position_m[4 * k][order])
                velocity.append(group["velocity"][:])
                self.assertEqual(group["id"][0], 1)
            velocity = numpy.vstack(velocity)
            numpy.testing.assert_allclose(file.attrs["velocity"], numpy.column_stack([velocity.min(0), velocity.mean(0), velocity.max(0)]))
            numpy.testing.assert_allclose(file["timestep 0/density"][:], 2500, rtol=1e-9)
            numpy.testing.assert_allclose(file.attrs["velocity magnitude"][1], numpy.linalg.norm(velocity, axis=1).mean())

    def test_a_track_as_text(self):
        recording = millscope.from_pept(circle(1), ["t", "x", "y", "z", "error"])
        track = next(iter(recording.values()))
        path = millscope.write_up4_csv(track, self.folder / "bead.csv")
        read = pandas.read_csv(path, float_precision="round_trip")
        self.assertEqual(read.columns.tolist(), ["t", "x", "y", "z"])
        numpy.testing.assert_array_equal(read.to_numpy(), numpy.column_stack([track.time_s, track.position_m]))

    def write_particles(self, name, kind, times):
        with h5py.File(self.folder / name, "w") as file:
            file.attrs.create("hdf5_up4_type", kind, dtype="u1")
            for k, time in enumerate(times):
                group = file.create_group(f"particle {k}")
                group["time"], group["position"], group["radius"] = time, numpy.arange(3.0 * len(time)).reshape(-1, 3), numpy.full(len(time), 0.002)
        return self.folder / name

    def test_particles_of_up4(self):
        tracks = millscope.read_up4(self.write_particles("two.hdf5", 2, [numpy.arange(4.0), numpy.arange(3.0)]))
        self.assertEqual(list(tracks), ["particle_0", "particle_1"])
        self.assertEqual((tracks["particle_0"].position_m.shape, tracks["particle_0"].diameter_m), ((4, 3), 0.004))
        for name, kind, times, line in (("frames.hdf5", 1, [], "hdf5_up4_type is 1, not 2"), ("back.hdf5", 2, [numpy.array([0.0, 2.0, 1.0])], "particle 0: time 1 s in row 2 is not after 2 s")):
            with self.subTest(name), self.assertRaisesRegex(millscope.Error, line):
                millscope.read_up4(self.write_particles(name, kind, times))


if __name__ == "__main__":
    unittest.main()
