"""The schema on what lies in configs/ and on what `millscope new` writes. Needs the Python modules jsonschema and yaml."""
import json
import pathlib
import re
import unittest

from support import COMMAND, SOURCE, CliTest

try:
    import jsonschema
    import yaml
except ImportError:
    jsonschema = None


def load(text):
    """As editors and millscope read YAML: only true and false are switches."""
    class Loader(yaml.SafeLoader):
        pass
    Loader.yaml_implicit_resolvers = {first: [(tag, pattern) for tag, pattern in some if not tag.endswith(":bool")]
                                      for first, some in yaml.SafeLoader.yaml_implicit_resolvers.items()}
    Loader.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile("^(true|false)$"), list("tf"))
    return yaml.load(text, Loader)


@unittest.skipIf(jsonschema is None, "needs the Python modules jsonschema and yaml")
class Schema(CliTest):
    def setUp(self):
        super().setUp()
        schema = json.loads(self.succeed("schema").stdout)
        jsonschema.Draft7Validator.check_schema(schema)
        self.validator = jsonschema.Draft7Validator(schema)

    def said(self, text):
        return sorted(error.message for error in self.validator.iter_errors(load(text)))

    def test_cases_and_parts_of_cases(self):
        tried = 0
        for path in sorted((SOURCE / "configs").rglob("*.yaml")):
            text = path.read_text(encoding="utf-8")
            if re.search(r"^(base|study|parts|case|files|format|observations|simulations|settings|profile):", text, re.M):
                continue  # a study, a challenge, a proof, a campaign, a recording, a profile, a camera
            self.assertEqual(self.said(text), [], path)
            tried += 1
        self.assertGreater(tried, 15)

    def test_of_a_whole_case_everything_is_demanded(self):
        said = self.said("schema_version: 1\nmaterials: {glass: {density: 1}}\ngeometry: {liner: {diameter: 1}}\nmill:\n")
        for key in ("fill", "beads", "contact", "pairs", "body_forces", "time", "poisson_ratio", "kind"):
            self.assertIn(f"'{key}' is a required property", said)
        self.assertTrue(any("None is not of type" in line for line in said))

    def test_of_a_part_nothing_is(self):
        self.assertEqual(self.said("geometry: {liner: {length: 20 mm}}\n"), [])
        self.assertEqual(self.said("schema_version: 1\ninclude: [common.yaml]\noutput: {vtk: ~}\nmill: ~\n"), [])

    def test_but_keys_and_types_hold(self):
        for text in ("mil: {speed: 1}", "geometry: {liner: {diametre: 1 m}}", "mill: {direction: left}", "geometry: {liner: {kind: mesh, lifters: 3}}"):
            self.assertEqual(len(self.said(text + "\n")), 1, text)

    def test_a_new_case_is_valid_and_names_its_schema(self):
        self.succeed("new", "my_mill", "--diameter", "150 mm", "--bead-size", "8 mm")
        text = (self.folder / "my_mill/case.yaml").read_text(encoding="utf-8")
        self.assertEqual(self.said(text), [])
        installed = pathlib.Path(COMMAND).resolve().parent.parent / "share/millscope/case.schema.json"
        if installed.exists():
            self.assertIn(f"# yaml-language-server: $schema={installed}\n", text)
            self.assertEqual(json.loads(installed.read_text(encoding="utf-8")), self.validator.schema)
        else:
            self.assertNotIn("$schema", text)


if __name__ == "__main__":
    unittest.main()
