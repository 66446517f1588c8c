// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace reachcast {

void for_each_number(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& work) {
  if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
  std::atomic<std::size_t> next{0};
  std::mutex mutex;  // of the two below
  std::size_t failed_at = count;
  std::exception_ptr error;
  // Numbers are handed out rising: when one fails, all smaller ones have begun, and those that begin later are larger.
  const auto take_work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        const std::scoped_lock lock(mutex);
        if (i < failed_at) failed_at = i, error = std::current_exception();
        next = count;
      }
    }
  };
  {
    std::vector<std::jthread> others;
    const std::size_t wanted = std::min<std::size_t>(threads, count);
    for (std::size_t i = 1; i < wanted; ++i) others.emplace_back(take_work);
    take_work();
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace reachcast
