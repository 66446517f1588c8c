// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/mocap/motion_file.hpp"

#include <filesystem>
#include <stdexcept>

#include "reachcast/mocap/acclaim.hpp"
#include "reachcast/mocap/bvh.hpp"
#include "reachcast/mocap/c3d.hpp"
#include "reachcast/mocap/csv_motion.hpp"
#include "reachcast/mocap/trc.hpp"
#include "text_scanner.hpp"

namespace reachcast {

MotionFile read_motion(const std::string& path, const MotionFileOptions& options) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (equal_ignoring_case(extension, ".bvh")) return read_bvh(path, options);
  if (equal_ignoring_case(extension, ".csv")) return read_csv_motion(path, options);
  if (equal_ignoring_case(extension, ".c3d")) return read_c3d(path, options);
  if (equal_ignoring_case(extension, ".trc")) return read_trc(path, options);
  if (equal_ignoring_case(extension, ".amc")) return read_amc(path, options);
  if (equal_ignoring_case(extension, ".asf")) {
    throw std::invalid_argument(path + ": an .asf holds a skeleton without motion; give the .amc beside it");
  }
  throw std::invalid_argument(path + ": expected a file that ends in .bvh, .csv, .c3d, .trc or .amc, found " +
                              (extension.empty() ? std::string("no ending") : quote(extension)));
}

}  // namespace reachcast
