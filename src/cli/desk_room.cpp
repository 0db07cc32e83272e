#include "cli/desk_room.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

namespace littoral::cli {

namespace {
/// Pages are closed without a word. One that is in use after all makes its objects again.
constexpr std::size_t most_pages = 8;
}  // namespace

DeskRoom::DeskRoom(desk::Given given, int threads)
    : given_(std::move(given)), threads_(threads), thread_([this] { work(); }) {}

DeskRoom::~DeskRoom() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
    waiting_.clear();
    if (current_) current_->cancel.cancel();
  }
  arrived_.notify_all();
  thread_.join();
}

DeskRoom::Place& DeskRoom::place_of(const std::string& page) {
  if (!places_.contains(page) && places_.size() >= most_pages)
    places_.erase(std::min_element(places_.begin(), places_.end(),
                                   [](auto& a, auto& b) { return a.second.used < b.second.used; }));
  Place& place = places_[page];
  place.used = ++uses_;
  if (!place.desk) place.desk = std::make_shared<desk::Desk>(given_);
  return place;
}

void DeskRoom::answer(const std::string& page, std::uint64_t call, std::string request,
                      std::function<void(std::string)> done) {
  {
    const std::lock_guard lock(mutex_);
    Job job{page, std::move(request), call, {}, std::move(done)};
    if (place_of(page).cancelled >= call) job.cancel.cancel();
    waiting_.push_back(std::move(job));
  }
  arrived_.notify_one();
}

void DeskRoom::cancel(const std::string& page, std::uint64_t call) {
  const std::lock_guard lock(mutex_);
  Place& place = place_of(page);
  place.cancelled = std::max(place.cancelled, call);
  const auto stop = [&](const Job& job) {
    if (job.page == page && job.call <= call) job.cancel.cancel();
  };
  std::for_each(waiting_.begin(), waiting_.end(), stop);
  if (current_) stop(*current_);
}

std::string DeskRoom::progress(const std::string& page) const {
  const std::lock_guard lock(mutex_);
  const auto found = places_.find(page);
  nlohmann::json out = {{"progress", 0}, {"stage", ""}};
  if (found != places_.end())
    out = {{"progress", found->second.fraction}, {"stage", found->second.stage}};
  return out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void DeskRoom::work() {
  while (true) {
    std::shared_ptr<desk::Desk> desk;
    std::shared_ptr<Job> job;
    {
      std::unique_lock lock(mutex_);
      current_ = nullptr;
      arrived_.wait(lock, [this] { return closing_ || !waiting_.empty(); });
      if (closing_) return;
      job = current_ = std::make_shared<Job>(std::move(waiting_.front()));
      waiting_.pop_front();
      Place& place = place_of(job->page);
      place.fraction = 0;
      place.stage.clear();
      desk = place.desk;
    }
    Context context;
    context.threads = threads_;
    context.cancel = job->cancel;
    context.progress = [this, &page = job->page](double fraction, const std::string& stage) {
      const std::lock_guard lock(mutex_);
      const auto found = places_.find(page);
      if (found == places_.end()) return;
      found->second.fraction = fraction;
      found->second.stage = stage;
    };
    job->done(desk->answer(job->request, context));
  }
}

}  // namespace littoral::cli
