"""What scripts/packaging/help_text.py reads of --help, from the versions of CLI11 in Debian 12 and Debian 13."""

import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts/packaging"))
import help_text  # noqa: E402 (found through the line above)

HEAD = """Write frames
Usage: railcast-generate sequence [OPTIONS] SCENARIO

Positionals:
  SCENARIO TEXT REQUIRED      Scenario file

Options:
  -h,--help                   Print this help message and exit
"""
# CLI11 2.1 of Debian 12.
OLDER = HEAD + """  --frames UINT:1 to 1000=10  Number of frames
  --format TEXT:{pcd,ply,mcap}=pcd
                              File format
  --fields TEXT=all           Fields to write
  --seed UINT                 Seed
"""
# CLI11 2.4 of Debian 13.
NEWER = HEAD + """  --frames UINT:1 to 1000 [10] 
                              Number of frames
  --format TEXT:{pcd,ply,mcap} [pcd] 
                              File format
  --fields TEXT [all]         Fields to write
  --seed UINT                 Seed
"""


class HelpText(unittest.TestCase):

    def test_both_layouts_say_the_same(self):
        older, newer = (help_text.read_help(["railcast-generate", "sequence"], text) for text in (OLDER, NEWER))
        self.assertEqual(older, newer)

    def test_an_option_has_its_values_default_and_text(self):
        command, subcommands = help_text.read_help(["railcast-generate", "sequence"], NEWER)
        self.assertEqual(subcommands, [])
        self.assertEqual(command.description, "Write frames")
        options = {option.names[-1]: option for option in command.options()}
        self.assertTrue(options["SCENARIO"].is_required)
        self.assertEqual(options["--help"].type, "")
        self.assertEqual((options["--frames"].values, options["--frames"].default), ("1 to 1000", "10"))
        self.assertEqual(options["--format"].choices(), ["pcd", "ply", "mcap"])
        self.assertEqual((options["--format"].default, options["--format"].text), ("pcd", "File format"))
        self.assertEqual((options["--fields"].default, options["--fields"].text), ("all", "Fields to write"))
        self.assertEqual((options["--seed"].default, options["--seed"].text), ("", "Seed"))

    def test_what_cannot_be_read_is_named(self):
        with self.assertRaisesRegex(ValueError, "cannot read the option '--broken TEXT \\?'"):
            help_text.read_option("--broken TEXT ?", "Text")

    def test_only_a_command_that_is_not_required_may_be_missing(self):
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder) / "railcast-analyze"
            program.write_text(f"""#!/bin/sh
if [ "$1" = sight ]; then echo "sight is part of the extra sight, which is not installed" >&2; exit 1; fi
cat << 'END'
{HEAD}
Subcommands:
  sight                       Not installed
END
""", encoding="utf-8")
            program.chmod(0o755)
            self.assertEqual(help_text.ask(program, required=["stats"]).subcommands, [])
            for required in (None, ["sight"]):
                with self.assertRaisesRegex(ValueError, "railcast-analyze sight: sight is part of the extra"):
                    help_text.ask(program, required=required)


if __name__ == "__main__":
    unittest.main()
