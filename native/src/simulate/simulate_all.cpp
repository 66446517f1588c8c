// SPDX-License-Identifier: GPL-3.0-or-later
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

#include "reachcast/motion/encode.hpp"
#include "reachcast/simulate/simulate_reach.hpp"

namespace reachcast::simulate {
namespace {

struct PersonsMotions {
  std::vector<MotionCode> codes;
  std::size_t left_out = 0;
};

PersonsMotions motions_of(const Person& person, std::size_t number, std::uint64_t seed) {
  PersonsMotions out;
  for (const Errand& errand : errands_of(person, number, derived_seed(seed, 100 + number))) {
    const Simulated simulated = simulate_reach(person, errand);
    if (simulated.shortfall_m > 0.0) {
      ++out.left_out;
      continue;
    }
    out.codes.push_back(encode_reach(simulated.reach));
    out.codes.push_back(encode_reach(mirrored(simulated.reach)));
    out.codes.back().is_mirrored = true;
  }
  return out;
}

}  // namespace

CorpusCounts simulate_all(std::uint64_t seed, unsigned threads, const std::vector<std::size_t>& only,
                          const std::function<void(std::vector<MotionCode>)>& take) {
  const std::vector<Person> people = make_people(seed);
  std::vector<std::size_t> numbers = only;
  for (std::size_t i = 0; only.empty() && i < people.size(); ++i) numbers.push_back(i);
  std::vector<PersonsMotions> made(numbers.size());
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failing;
  const auto work = [&] {
    try {
      for (std::size_t i = next++; i < numbers.size(); i = next++) {
        made[i] = motions_of(people.at(numbers[i]), numbers[i], seed);
      }
    } catch (...) {
      const std::lock_guard lock(failing);
      failure = std::current_exception();
    }
  };
  std::vector<std::thread> workers;
  for (unsigned i = 1; i < threads; ++i) workers.emplace_back(work);
  work();
  for (std::thread& worker : workers) worker.join();
  if (failure) std::rethrow_exception(failure);
  CorpusCounts counts;
  for (PersonsMotions& motions : made) {
    counts.simulated += motions.codes.size() / 2;
    counts.left_out += motions.left_out;
    take(std::move(motions.codes));
  }
  return counts;
}

}  // namespace reachcast::simulate
