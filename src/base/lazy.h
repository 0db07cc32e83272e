#pragma once
// Things that are made when they are first needed and then kept, for objects that several threads
// use at once.

#include <map>
#include <memory>
#include <mutex>
#include <type_traits>

namespace littoral {

/// One value for each key. A second thread that asks for a value waits until the first has made it;
/// if making it throws, nothing is kept and the next one tries again.
template <class Key, class T>
class KeptByKey {
 public:
  /// The value of the key; `make()` returns a T, or a shared pointer to one that cannot be moved.
  template <class Make>
  std::shared_ptr<const T> get(const Key& key, const Make& make) const {
    const std::lock_guard lock(mutex_);
    std::shared_ptr<const T>& value = values_[key];
    if (!value) {
      if constexpr (std::is_convertible_v<decltype(make()), std::shared_ptr<const T>>)
        value = make();
      else
        value = std::make_shared<const T>(make());
    }
    return value;
  }

 private:
  mutable std::mutex mutex_;
  mutable std::map<Key, std::shared_ptr<const T>> values_;
};

/// One value.
template <class T>
class Kept {
 public:
  template <class Make>
  std::shared_ptr<const T> get(const Make& make) const {
    return value_.get(0, make);
  }

 private:
  KeptByKey<int, T> value_;
};

/// The value of the key that was asked for last: for keys that sources choose, which could be any
/// number of them.
template <class Key, class T>
class KeptLast {
 public:
  template <class Make>
  std::shared_ptr<const T> get(const Key& key, const Make& make) const {
    const std::lock_guard lock(mutex_);
    if (!value_ || !(key_ == key)) {
      value_ = std::make_shared<const T>(make());
      key_ = key;
    }
    return value_;
  }

 private:
  mutable std::mutex mutex_;
  mutable Key key_{};
  mutable std::shared_ptr<const T> value_;
};

}  // namespace littoral
