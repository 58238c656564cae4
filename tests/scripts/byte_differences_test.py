"""What scripts/dev/byte_differences.py names of two folders."""

import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts/dev"))
import byte_differences  # noqa: E402 (found through the line above)


class ByteDifferences(unittest.TestCase):

    def difference(self, name, before, now):
        return byte_differences.difference(name, before, now)

    def test_name_the_offset_in_a_binary_file(self):
        self.assertEqual(self.difference("000000.bin", b"\xff\x00\x01\x02", b"\xff\x00\x07\x03"),
                         "byte 2: 0x01 became 0x07, and 1 more places")
        self.assertEqual(self.difference("000000.bin", b"\xff\x00", b"\xff\x00\x07"), "byte 2: size 2 became size 3")
        self.assertEqual(self.difference("world.ply", b"\xff" * 100000, b"\xff" * 70000 + b"\x01" + b"\xff" * 29999),
                         "byte 70000: 0xff became 0x01")

    def test_name_the_pointer_in_json(self):
        self.assertEqual(self.difference("stats.json", b'{"a": [1, {"b": 2}]}', b'{"a": [1, {"b": 3}]}'), "/a/1/b: 2 became 3")
        self.assertEqual(self.difference("frames.jsonl", b'{"a": 1}\n{"a": 2}\n', b'{"a": 1}\n{"a": 2.5}\n'),
                         "/1/a: 2 became 2.5")

    def test_name_the_line_of_json_of_which_only_the_text_differs(self):
        self.assertEqual(self.difference("a.json", b'{"a": 1.0}', b'{"a": 1.00}'),
                         "line 1: '{\"a\": 1.0}' became '{\"a\": 1.00}'")

    def test_name_column_and_row_in_csv(self):
        self.assertEqual(self.difference("poses.csv", b"x,y\n1,2\n3,4\n", b"x,y\n1,2\n3,5\n"), "row 2, y: 4 became 5")
        self.assertEqual(self.difference("poses.csv", b"x,y\n1,2\n", b"x,y\n"), "line 2: '1,2\\n' became no line")

    def test_name_a_line_that_ends_otherwise(self):
        self.assertEqual(self.difference("check.txt", b"whole\n", b"whole\r\n"), "line 1: 'whole\\n' became 'whole\\r\\n'")

    def test_leave_out_what_versions_and_clocks_change(self):
        self.assertIsNone(self.difference("run.json", b'{"version": "1.0.0+0123456789ab", "report_xxh3": "ab"}',
                                          b'{"version": "1.0.0-rc.1+ba9876543210.dirty.01234567", "report_xxh3": "cd"}'))
        self.assertIsNone(self.difference("out.txt", b"after 0:31: 45 %\nwhole\n", b"after 0:32: 40 %\nafter 1:02: 80 %\nwhole\n"))
        self.assertIsNone(self.difference("own.txt", b"2 frames in 1.5 s\n", b"2 frames in 2.25 s\n"))
        self.assertIsNone(self.difference("frontier/frontier.csv", b"row,p50_ms,missed\na,1,2\n", b"row,p50_ms,missed\na,3,2\n"))
        self.assertEqual(self.difference("frontier/frontier.csv", b"row,p50_ms,missed\na,1,2\n", b"row,p50_ms,missed\na,1,3\n"),
                         "row 1, missed: 2 became 3")

    def test_do_not_leave_out_hashes_of_content(self):
        self.assertEqual(self.difference("frames.jsonl", b'{"xxh3": "ab"}\n', b'{"xxh3": "cd"}\n'), '/0/xxh3: "ab" became "cd"')

    def test_name_files_that_come_and_go(self):
        with tempfile.TemporaryDirectory() as name:
            before, now = pathlib.Path(name, "before"), pathlib.Path(name, "now")
            for folder, files in ((before, ("a/old.txt", "same.txt", "live/arrived.txt")), (now, ("a/new.txt", "same.txt"))):
                for file in files:
                    (folder / file).parent.mkdir(parents=True, exist_ok=True)
                    (folder / file).write_text(f"its place is {folder.resolve()}")
            self.assertEqual(list(byte_differences.differences(before, now)), [("a/new.txt", "new"), ("a/old.txt", "gone")])


if __name__ == "__main__":
    unittest.main()
