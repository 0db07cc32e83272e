#include "methods/geodesic/wave_queue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <vector>

namespace littoral {
namespace {

using ::testing::ElementsAreArray;

/// The same with nothing but its definition.
struct SimpleWaves {
  std::map<int, WaveQueue::Entry> entries;

  double least() const {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [id, entry] : entries) least = std::min(least, entry.key);
    return least;
  }
  std::vector<int> wave() const {
    double end = std::numeric_limits<double>::infinity();
    for (const auto& [id, entry] : entries) end = std::min(end, entry.key + double(entry.lead));
    std::vector<int> ids;
    for (const auto& [id, entry] : entries)
      if (entry.key <= end) ids.push_back(id);
    return ids;
  }
};

std::vector<int> sorted(std::vector<int> ids) {
  std::sort(ids.begin(), ids.end());
  return ids;
}

/// Entries of very different lead, each of which sends others that are due later.
TEST(WaveQueue, TakesTogetherWhatIsDueBeforeAnyOfItSendsSomething) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> real(0, 1);
  for (const double spread : {0.0, 3.0, 12.0}) {
    WaveQueue queue;
    SimpleWaves simple;
    int n = 0;
    const auto push = [&](double after) {
      const auto lead = float(std::exp(-spread * real(random)));
      const WaveQueue::Entry entry{after + real(random) * double(lead), n++, lead};
      queue.push(entry);
      simple.entries[entry.id] = entry;
    };
    for (int i = 0; i < 300; ++i) push(5 * real(random));
    for (int waves = 0; !simple.entries.empty(); ++waves) {
      ASSERT_FALSE(queue.empty());
      EXPECT_EQ(queue.least(), simple.least());
      std::vector<WaveQueue::Entry> taken;
      std::vector<int> ids;
      queue.take_wave(queue.least(), queue.until(), [&](const WaveQueue::Entry& entry) {
        taken.push_back(entry);
        ids.push_back(entry.id);
        return true;
      });
      ASSERT_THAT(sorted(ids), ElementsAreArray(simple.wave()));
      for (const WaveQueue::Entry& entry : taken) {
        simple.entries.erase(entry.id);
        for (int sent = 0; sent < 2 && n < 20000; ++sent) push(entry.until());
      }
      int n_left = 0;
      queue.for_each([&](const WaveQueue::Entry&) { ++n_left; });
      EXPECT_EQ(n_left, int(simple.entries.size()));
    }
    EXPECT_TRUE(queue.empty());
    EXPECT_EQ(queue.least(), std::numeric_limits<double>::infinity());
  }
}

TEST(WaveQueue, KeepsWhatIsNotTaken) {
  WaveQueue queue;
  for (int id = 0; id < 10; ++id) queue.push({1, id, 0.5F});
  std::vector<int> seen;
  while (!queue.empty()) {
    int n = 0;
    queue.take_wave(queue.least(), queue.until(), [&](const WaveQueue::Entry& entry) {
      if (n == 3) return false;
      ++n;
      seen.push_back(entry.id);
      return true;
    });
    EXPECT_LE(n, 3);
    EXPECT_GE(n, 1);
  }
  EXPECT_THAT(sorted(seen), ElementsAreArray({0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

}  // namespace
}  // namespace littoral
