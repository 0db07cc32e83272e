#pragma once
// Things sorted into groups, group by group in one list.

#include <cstddef>
#include <span>
#include <vector>

namespace littoral {

/// Lists of members, one for each group, in the order in which members were given.
template <class Member>
struct Groups {
  std::vector<int> begin;  // groups + 1
  std::vector<Member> members;

  std::span<const Member> at(int group) const {
    return {members.data() + begin[group], members.data() + begin[group + 1]};
  }
};

/// for_members(put) calls put(group, member) for each member; it is called twice, and has to give
/// the same both times.
template <class Member, class ForMembers>
Groups<Member> groups_of(std::size_t n_groups, const ForMembers& for_members) {
  Groups<Member> out{std::vector<int>(n_groups + 1, 0), {}};
  for_members([&](int group, const Member&) { ++out.begin[std::size_t(group) + 1]; });
  for (std::size_t g = 0; g < n_groups; ++g) out.begin[g + 1] += out.begin[g];
  out.members.resize(std::size_t(out.begin.back()));
  std::vector<int> next(out.begin.begin(), out.begin.end() - 1);
  for_members([&](int group, const Member& member) { out.members[next[group]++] = member; });
  return out;
}

}  // namespace littoral
