"""What tools/verify.py reads off drums: beds whose surface is known, a picture, data that are not there."""

import os
import subprocess
import sys
import unittest
from pathlib import Path
from tempfile import TemporaryDirectory

sys.dont_write_bytecode = True
TOOLS = Path(__file__).resolve().parents[2] / "tools"
sys.path.insert(0, str(TOOLS))
try:
    import numpy

    import drum_surface
except ImportError:
    numpy = None

BORE, ANGLE, DEPTH = 0.1, 31.0, 0.004  # m, deg; the surface lies so far below the axis, m


def bed(frames=8, beads=20000):
    """Tiny beads everywhere below a plane; they turn with the drum, those next to the surface flow down it."""
    random = numpy.random.default_rng(1)
    at = random.uniform(-BORE / 2, BORE / 2, (frames, beads, 3))
    c, s = numpy.cos(numpy.radians(ANGLE)), numpy.sin(numpy.radians(ANGLE))
    along, up = c * at[..., 0] + s * at[..., 1], c * at[..., 1] - s * at[..., 0]
    at[(up > -DEPTH) | (numpy.hypot(at[..., 0], at[..., 1]) > BORE / 2)] = 10  # m: out of the picture
    velocity = numpy.zeros_like(at)
    velocity[..., 0], velocity[..., 1] = -at[..., 1], at[..., 0]
    flows = up > -DEPTH - 0.005
    speed = 1 - (2 * along / BORE) ** 2
    velocity[flows, 0], velocity[flows, 1] = -(speed * c)[flows], -(speed * s)[flows]
    return at, velocity, numpy.full(beads, 0.0006)


@unittest.skipUnless(numpy, "needs numpy")
class Surface(unittest.TestCase):
    def test_angle_of_a_plane_by_density_and_by_silhouette(self):
        places, _, radii = bed()
        found = drum_surface.surface(*drum_surface.pictures(places, radii, BORE), BORE)
        self.assertAlmostEqual(found["angle"], ANGLE, delta=0.3)
        self.assertAlmostEqual(found["outline"], ANGLE, delta=0.3)
        self.assertLess(found["misfit"], BORE / drum_surface.CELLS)
        self.assertLess(found["error"], 0.3)
        segment = numpy.arccos(2 * DEPTH / BORE) - 2 * DEPTH / BORE * numpy.sqrt(1 - (2 * DEPTH / BORE) ** 2)
        self.assertAlmostEqual(found["covered"], segment / numpy.pi, delta=0.02)

    def test_speed_along_the_surface(self):
        places, velocities, radii = bed()
        place, down, error = drum_surface.along(places, velocities, radii, BORE, ANGLE, 0.004)
        for x, v, e in zip(place, down, error):
            if abs(x) < 0.9:
                self.assertAlmostEqual(v, 1 - x * x, delta=0.02)
                self.assertLess(e, 0.02)

    def test_beads_that_turn_with_the_shell_do_not_slip(self):
        places, velocities, radii = bed()
        self.assertAlmostEqual(drum_surface.wall_slip(places, velocities, radii, BORE, 1.0), 100, delta=0.01)
        self.assertAlmostEqual(drum_surface.wall_slip(places, velocities, radii, BORE, 2.0), 50, delta=0.01)

    def test_a_picture_upside_down_in_its_file(self):
        with TemporaryDirectory() as folder:
            path = Path(folder) / "three.bmp"
            header = b"BM" + (0).to_bytes(8, "little") + (54 + 1024).to_bytes(4, "little") + (40).to_bytes(4, "little")
            header += (3).to_bytes(4, "little") + (2).to_bytes(4, "little") + (1).to_bytes(2, "little") + (8).to_bytes(2, "little") + bytes(24)
            palette = b"".join(bytes((255 - k,) * 3 + (0,)) for k in range(256))
            path.write_bytes(header + palette + bytes([0, 1, 2, 0, 10, 11, 12, 0]))
            self.assertEqual(drum_surface.read_bmp(path).tolist(), [[245, 244, 243], [255, 254, 253]])
            path.write_bytes(b"GIF89a" + bytes(60))
            with self.assertRaisesRegex(ValueError, "no BMP of 8 bits"):
                drum_surface.read_bmp(path)


class Absent(unittest.TestCase):
    def test_data_that_are_not_there_are_not_run(self):
        program = "import verify_drums as v, verify_granudrum as g\nfor item in (v.beads6000, v.alizadeh, g.granudrum, g.cellulose, g.rolling):\n    print(item(None))"
        with TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, "-B", "-c", program], cwd=TOOLS, text=True, capture_output=True,
                                  env=dict(os.environ, MILLSCOPE_DATA=folder), check=True)
        self.assertEqual(done.stdout.count("not run"), 5)
        self.assertNotIn("True", done.stdout)
        self.assertNotIn("False", done.stdout)


if __name__ == "__main__":
    unittest.main()
