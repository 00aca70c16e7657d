"""The harness finds what it is there for: each rule is broken by a command, and told. `python3 -m unittest` runs it."""

import os
import pathlib
import signal
import tempfile
import unittest

import harness


def faults(script, expected="any", folder_files=("input",), **rules):
    """What is told of a command of the shell."""
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        for name in folder_files:
            (folder / name).write_text("input\n")
        trial = harness.Trial(folder)
        trial.judge(["bash", "-c", script], expected, **rules)
        return " ".join(trial.verdict.faults)


class Rules(unittest.TestCase):
    def test_a_good_command_is_good(self):
        self.assertEqual(faults("cat input", "taken", says=["input"]), "")
        self.assertEqual(faults("echo 'no input' >&2; exit 1", "bad", names="input"), "")
        self.assertEqual(faults("echo x > out", "taken", writes=["out"]), "")

    def test_status_and_signals(self):
        self.assertIn("status 0, expected refused", faults("true", "refused"))
        self.assertIn("status 1, expected taken", faults("echo no >&2; exit 1", "taken"))
        self.assertIn("status 101, expected any", faults("exit 101"))
        self.assertIn(f"signal {signal.SIGABRT.value}, expected any", faults("kill -ABRT $$"))

    def test_words(self):
        self.assertIn("panics", faults("echo \"thread 'main' panicked at x.rs\" >&2; exit 1"))
        self.assertIn("no message", faults("exit 1"))
        self.assertIn("status 2 with standard output", faults("echo x; exit 2"))
        self.assertIn("does not name input", faults("echo no >&2; exit 1", names="input"))
        self.assertIn("does not say 'x'", faults("true", says=["x"]))
        self.assertIn("says 'x'", faults("echo x", never=["x"]))
        self.assertIn("escape codes", faults(r"printf '\033[31m'"))

    def test_files(self):
        self.assertIn("changes input", faults("echo x > input"))
        self.assertIn("loses input", faults("rm input"))
        self.assertIn("leaves .out.tmp", faults("echo x > .out.tmp"))
        self.assertIn("changes input", faults("rm input; ln -s /dev/null input"))

    def test_time_and_memory(self):
        self.assertIn("takes more than 1 s of processor time", faults("while :; do :; done", seconds=1))
        large = "python3 -c 'x = bytearray(300 << 20); x[::4096] = bytes(len(x[::4096]))'"
        self.assertIn("MB", faults(large, megabytes=200))
        self.assertEqual(faults(large, megabytes=500), "")
        self.assertIn("does not end", faults("sleep 60", clock=0.2))

    def test_cases(self):
        with tempfile.TemporaryDirectory() as place:
            run = lambda body, clock=None: harness.run(harness.Case("name", body, clock), pathlib.Path(place)).faults
            self.assertEqual(run(lambda trial: None), [])
            self.assertIn("division", run(lambda trial: 1 / 0)[0])
            self.assertIn("its process ends", run(lambda trial: os.abort())[0])
            self.assertIn("does not end", run(lambda trial: signal.pause(), clock=0.1)[0])
            self.assertEqual(
                harness.run(harness.Case("name", self.skips), pathlib.Path(place)).skipped, "no such thing"
            )

    @staticmethod
    def skips(trial):
        raise harness.Skipped("no such thing")

    def test_a_draw_depends_on_seed_and_name_alone(self):
        drawn = lambda seed, share: {i for i in range(10_000) if harness.is_drawn("script", str(i), seed, share)}
        self.assertEqual(drawn("1", 1.0), set(range(10_000)))
        self.assertEqual(drawn("1", 0.0), set())
        self.assertLess(abs(len(drawn("1", 0.1)) - 1000), 150)
        self.assertEqual(drawn("1", 0.1), drawn("1", 0.1))
        self.assertNotEqual(drawn("1", 0.1), drawn("2", 0.1))
        self.assertLessEqual(drawn("1", 0.1), drawn("1", 0.2))

    def test_two_cases_of_one_name(self):
        cases = harness.Cases()
        cases.add("a", None)
        with self.assertRaises(ValueError):
            cases.add("a", None)


if __name__ == "__main__":
    unittest.main()
