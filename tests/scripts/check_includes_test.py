# SPDX-License-Identifier: MIT
"""scripts/check-includes passes the tree as it is and catches every kind of violation."""

import pathlib
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def check(root):
    return subprocess.run([ROOT / "scripts" / "check-includes", root], capture_output=True, text=True)


class CheckIncludes(unittest.TestCase):
    def check_files(self, files):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in files.items():
                path = pathlib.Path(folder) / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text + "\n")
            return check(folder)

    def assert_caught(self, name, line, why):
        result = self.check_files({name: "// a comment\n" + line})
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn(f"{name}:2: ", result.stdout)
        self.assertIn(why, result.stdout)

    def assert_allowed(self, files):
        result = self.check_files(files)
        self.assertEqual(result.returncode, 0, result.stdout)

    def test_the_tree_keeps_the_rule(self):
        result = check(ROOT)
        self.assertEqual(result.returncode, 0, result.stdout)

    def test_core_includes_nothing_of_ours(self):
        self.assert_caught("core/a.cc", '#include "rig/face_rig.h"', "core/ must not include rig/")

    def test_stages_do_not_know_one_another(self):
        self.assert_caught("fitting/a.cc", '#include "tracking/stabilize.h"',
                           "fitting/ must not include tracking/")
        self.assert_caught("tracking/a.h", '  #  include "fitting/fit.h"',
                           "tracking/ must not include fitting/")

    def test_apps_and_tests_see_all_stages(self):
        self.assert_allowed({"apps/a.cc": '#include "tracking/stabilize.h"',
                             "tests/fitting/a.cc": '#include "synthetic/speaker.h"'})

    def test_libraries_stay_in_their_folders(self):
        self.assert_caught("rig/a.cc", "#include <ceres/ceres.h>", "belongs to")
        self.assert_caught("tracking/a.cc", "#include <pcl/point_types.h>", "belongs to fitting")
        self.assert_caught("core/a.cc", "#include <opencv2/core.hpp>", "belongs to")
        self.assert_allowed({"fitting/a.cc": "#include <ceres/ceres.h>",
                             "core/a.cc": "#include <fmt/format.h>"})

    def test_what_core_shows_exposes_eigen_alone(self):
        inside = {"core/io/text.h": "#include <fmt/format.h>",
                  "core/io/text.cc": '#include "core/io/text.h"'}
        self.assert_allowed(inside)
        self.assert_allowed({"core/a.h": "#include <Eigen/Core>\n#include <tl/expected.hpp>",
                             "rig/a.cc": '#include "core/a.h"'})
        outside = {**inside, "core/a.h": '#include "core/io/text.h"'}
        result = self.check_files({**outside, "rig/a.cc": '#include "core/a.h"'})
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn("rig/a.cc:1: core/a.h: exposes <fmt/format.h>", result.stdout)

    def test_include_paths_start_at_the_root(self):
        self.assert_caught("core/a.cc", '#include "tracks.h"', "start at the project's root")
        self.assert_caught("core/a.cc", '#include "../core/a.h"', "start at the project's root")


if __name__ == "__main__":
    unittest.main()
