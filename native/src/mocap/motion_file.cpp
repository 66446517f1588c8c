// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/mocap/motion_file.hpp"

#include <filesystem>
#include <stdexcept>

#include "reachcast/mocap/bvh.hpp"
#include "reachcast/mocap/csv_motion.hpp"
#include "text_scanner.hpp"

namespace reachcast {

MotionFile read_motion(const std::string& path, const MotionFileOptions& options) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (equal_ignoring_case(extension, ".bvh")) return read_bvh(path, options);
  if (equal_ignoring_case(extension, ".csv")) return read_csv_motion(path, options);
  throw std::invalid_argument(path + ": expected a file that ends in .bvh or .csv, found " +
                              (extension.empty() ? std::string("no ending") : quote(extension)));
}

}  // namespace reachcast
