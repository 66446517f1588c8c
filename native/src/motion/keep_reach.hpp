// SPDX-License-Identifier: GPL-3.0-or-later
/// Turns frames into a reach or a rejection. Private to motion/.
#pragma once

#include <string>

#include "reachcast/motion/find_reaches.hpp"

namespace reachcast {

class Keeper {
 public:
  /// Throws as find_reaches does. What is given must outlive the keeper.
  Keeper(const Clip& clip, const Subject& subject, const FindOptions& options, const Evidence& evidence);

  /// Cuts the frames out, or notes the reason why they are left out; what cut_reach refuses is a reason too.
  void keep(const FrameRange& frames, Phase phase, Hands hands, const std::string& reason, FoundReaches& found) const;

 private:
  const Clip& clip_;
  const Subject& subject_;
  const FindOptions& options_;
  std::string origin_;
};

}  // namespace reachcast
