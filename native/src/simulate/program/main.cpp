// SPDX-License-Identifier: GPL-3.0-or-later
/// reachcast_simulate --out FILE [--seed N] [--threads N] [--people 1,2,...]: makes the corpus that ships.
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>

#include "reachcast/corpus/corpus.hpp"
#include "reachcast/simulate/simulate_reach.hpp"

namespace {

using namespace reachcast;

constexpr const char* kDescription =
    "Simulated, nobody was recorded: 20 people of 1.47 to 1.95 m and 20 to 70 years carry a box to 30 places on "
    "shelves "
    "and back, each motion in postures of least effort";

std::uint64_t number(const std::string& option, std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw std::invalid_argument(option + " is '" + std::string(text) + "'; it must be a whole number");
  return value;
}

struct Options {
  std::filesystem::path out;
  std::uint64_t seed = 2004;
  unsigned threads = 2;
  std::vector<std::size_t> people;
};

Options parse(int count, char** words) {
  Options options;
  for (int i = 1; i < count; i += 2) {
    const std::string name = words[i];
    if (i + 1 == count) throw std::invalid_argument(name + " needs a value");
    const std::string value = words[i + 1];
    if (name == "--out") {
      options.out = value;
    } else if (name == "--seed") {
      options.seed = number(name, value);
    } else if (name == "--threads") {
      options.threads = static_cast<unsigned>(number(name, value));
      if (options.threads < 1 || options.threads > 64)
        throw std::invalid_argument("--threads is " + value + "; it must lie between 1 and 64");
    } else if (name == "--person") {
      const std::uint64_t who = number(name, value);
      if (who < 1 || who > simulate::kPeople)
        throw std::invalid_argument("--person is " + value + "; it must lie between 1 and 20");
      options.people.push_back(who - 1);
    } else {
      throw std::invalid_argument("unknown option " + name + "; known are --out, --seed, --threads and --person");
    }
  }
  if (options.out.empty()) throw std::invalid_argument("--out names the corpus to make and is missing");
  return options;
}

}  // namespace

int main(int count, char** words) {
  try {
    const Options options = parse(count, words);
    Corpus corpus = Corpus::create(options.out, "reachcast_simulate", Precision::compact);
    corpus.set_meta("kind", "simulated");
    corpus.set_meta("description", kDescription);
    corpus.set_meta("seed", std::to_string(options.seed));
    const simulate::CorpusCounts counts =
        simulate::simulate_all(options.seed, options.threads, options.people,
                               [&](const std::vector<MotionCode>& codes) { corpus.add(codes); });
    std::cout << options.out.string() << ": " << counts.simulated << " simulated motions and their mirror images, "
              << counts.left_out << " left out as out of reach\n";
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "reachcast_simulate: " << error.what() << "\n";
    return 1;
  }
}
