// SPDX-License-Identifier: GPL-3.0-or-later
/// Shared by the tests of mocap/: where recordings are, small files made by hand, and what an error says.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

namespace reachcast::test {

/// The folder of recordings: $REACHCAST_MOCAP, else ../shared/mocap beside the project. It may be absent.
inline std::filesystem::path mocap_folder() {
  if (const char* given = std::getenv("REACHCAST_MOCAP")) return given;
  return std::filesystem::path(__FILE__).parent_path() / "../../../../shared/mocap";
}

#define REACHCAST_NEED_MOCAP(part)                                                                     \
  if (!std::filesystem::exists(reachcast::test::mocap_folder() / (part))) {                            \
    GTEST_SKIP() << "recordings are missing: " << (reachcast::test::mocap_folder() / (part)).string(); \
  }

/// The message of the std::invalid_argument that the call throws; empty when it throws none.
template <typename Call>
std::string complaint(Call call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

/// A two-joint skeleton whose forward kinematics can be done in the head.
inline const std::string kSmallBvh =
    "HIERARCHY\n"
    "ROOT Hips\n"
    "{\n"
    "  OFFSET 7 8 9\n"
    "  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
    "  JOINT Arm\n"
    "  {\n"
    "    OFFSET 0 10 0\n"
    "    CHANNELS 3 Zrotation Xrotation Yrotation\n"
    "    End Site\n"
    "    {\n"
    "      OFFSET 0 5 0\n"
    "    }\n"
    "  }\n"
    "}\n"
    "MOTION\n"
    "Frames: 2\n"
    "Frame Time: .05\n"
    "1 2 3 0 0 0 0 0 0\n"
    "1 2 3 90 0 0 0 90 0\n";

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("the test looks for text that is not there: " + from);
  return text.replace(at, from.size(), to);
}

}  // namespace reachcast::test
