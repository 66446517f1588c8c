// SPDX-License-Identifier: GPL-3.0-or-later
/// Independent pieces of work on several threads. Blender brings its own OpenMP and TBB, so this uses neither.
#pragma once

#include <cstddef>
#include <functional>

namespace reachcast {

/// work(0), ..., work(count - 1), each once, in any order, on `threads` threads (0: as many as the machine has). Where
/// some throw, the error of the smallest number is thrown when all threads have ended; the others may not have run.
void for_each_number(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& work);

}  // namespace reachcast
