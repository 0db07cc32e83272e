#pragma once
// The desks of the pages that are open, and one thread that works for all of them.

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "desk/desk.h"

namespace littoral::cli {

class DeskRoom {
 public:
  DeskRoom(desk::Given given, int threads);
  /// Stops what is being computed.
  ~DeskRoom();
  DeskRoom(const DeskRoom&) = delete;
  DeskRoom& operator=(const DeskRoom&) = delete;

  /// Calls of one page are counted upwards. `done` is called with the answer, by another thread.
  void answer(const std::string& page, std::uint64_t call, std::string request,
              std::function<void(std::string)> done);
  /// Stops this call and those before it, also one that has not arrived yet.
  void cancel(const std::string& page, std::uint64_t call);
  /// {"progress", "stage"} of the call under way.
  std::string progress(const std::string& page) const;

 private:
  struct Job {
    std::string page, request;
    std::uint64_t call;
    CancelToken cancel;
    std::function<void(std::string)> done;
  };
  /// What is kept of a page.
  struct Place {
    std::shared_ptr<desk::Desk> desk;
    std::uint64_t cancelled = 0, used = 0;
    double fraction = 0;
    std::string stage;
  };
  void work();
  Place& place_of(const std::string& page);

  const desk::Given given_;
  const int threads_;
  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<Job> waiting_;
  std::map<std::string, Place> places_;
  std::uint64_t uses_ = 0;
  std::shared_ptr<Job> current_;
  bool closing_ = false;
  std::thread thread_;
};

}  // namespace littoral::cli
