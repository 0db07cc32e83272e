#include "solve/direct/elimination.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "base/fetch_ahead.h"
#include "base/index.h"
#include "base/now_and_then.h"
#include "base/parallel.h"

namespace littoral {

namespace {

constexpr std::size_t supernode_grain = 1024;

void sums_to_begins(std::vector<int>& counts) {
  int sum = 0;
  for (int& c : counts) sum += std::exchange(c, sum);
}

/// Calls put(e, a, b) for entry e of a symmetric matrix's lower triangle, whose column and row have
/// the new numbers a and b, and some entries before that fetch(a, b): what is numbered anew lies in
/// any order.
template <class Scalar, class Fetch, class Put>
void for_entries(const Eigen::SparseMatrix<Scalar>& lower, const std::vector<int>& new_of,
                 const Task& task, const Fetch& fetch, const Put& put) {
  constexpr int ahead = 16, half = ahead / 2;
  struct Entry {
    int a, b;
  };
  std::array<Entry, ahead> ring;
  const int n = static_cast<int>(lower.nonZeros());
  const int* const row_of = lower.innerIndexPtr();
  int e = 0;
  for (int j = 0; j < lower.outerSize(); ++j) {
    stop_now_and_then(j, task);
    const int a = new_of[j];
    for (typename Eigen::SparseMatrix<Scalar>::InnerIterator it(lower, j); it; ++it, ++e) {
      if (e + ahead < n) fetch_ahead(&new_of[row_of[e + ahead]]);
      Entry& here = ring[e % ahead];
      if (e >= half) {
        const Entry& due = ring[(e - half) % ahead];
        put(e - half, due.a, due.b);
      }
      here = {a, new_of[it.row()]};
      fetch(here.a, here.b);
    }
  }
  for (int left = std::max(0, e - half); left < e; ++left)
    put(left, ring[left % ahead].a, ring[left % ahead].b);
}

/// Parents of the unknowns in the elimination tree, and how many entries each column of the
/// renumbered lower triangle has (Liu 1986).
struct Tree {
  std::vector<int> parent, entries;
};

template <class Scalar>
Tree elimination_tree(const Eigen::SparseMatrix<Scalar>& lower, const std::vector<int>& new_of,
                      const Task& task) {
  const int n = int_size(new_of);
  Tree tree{std::vector<int>(new_of.size(), -1), std::vector<int>(new_of.size(), 0)};
  std::vector<int> begin(new_of.size() + 1, 0);  // row -> columns left of the diagonal
  for_entries(
      lower, new_of, task,
      [&](int a, int b) {
        fetch_ahead(&tree.entries[std::min(a, b)]);
        fetch_ahead(&begin[std::max(a, b)]);
      },
      [&](int, int a, int b) {
        ++tree.entries[std::min(a, b)];
        if (a != b) ++begin[std::max(a, b)];
      });
  sums_to_begins(begin);
  std::vector<int> left(begin[new_of.size()]), at = begin;
  for_entries(
      lower, new_of, task, [&](int a, int b) { fetch_ahead(&left.data()[at[std::max(a, b)]]); },
      [&](int, int a, int b) {
        if (a != b) left[at[std::max(a, b)]++] = std::min(a, b);
      });
  std::vector<int>& ancestor = at;
  std::fill(ancestor.begin(), ancestor.end(), -1);
  for (int i = 0; i < n; ++i) {
    stop_now_and_then(i, task);
    for (int e = begin[i]; e < begin[i + 1]; ++e)
      for (int j = left[e]; j != -1 && j != i;) {
        const int next = std::exchange(ancestor[j], i);
        if (next == -1) tree.parent[j] = i;
        j = next;
      }
  }
  return tree;
}

/// Children before parents, every subtree in one run: post[k] is the k-th node.
std::vector<int> postorder(const std::vector<int>& parent) {
  const int n = parent.size();
  std::vector<int> child(n, -1), sibling(n, -1), post, stack;
  for (int i = n - 1; i >= 0; --i)
    if (parent[i] >= 0) sibling[i] = std::exchange(child[parent[i]], i);
  post.reserve(parent.size());
  for (int root = 0; root < n; ++root) {
    if (parent[root] >= 0) continue;
    stack.push_back(root);
    while (!stack.empty()) {
      const int i = stack.back();
      if (child[i] >= 0) {
        stack.push_back(std::exchange(child[i], sibling[child[i]]));
      } else {
        post.push_back(i);
        stack.pop_back();
      }
    }
  }
  return post;
}

/// Entries of each column of the factor, the diagonal among them, for postordered unknowns: a row's
/// entries are the paths of the tree from the columns of its leaves up to the row (Gilbert, Ng,
/// Peyton 1994). begin, row: rows of the matrix's entries, column by column.
std::vector<int> column_counts(const std::vector<int>& begin, const std::vector<int>& row,
                               const std::vector<int>& parent, const Task& task) {
  const int n = parent.size();
  std::vector<int> first(n, -1), last_leaf(n, -1), reach(n, -1), set(n), count(n, 0);
  std::iota(set.begin(), set.end(), 0);
  for (int j = 0; j < n; ++j) {
    if (first[j] < 0) count[j] = 1;  // a leaf of the tree
    for (int i = j; i >= 0 && first[i] < 0; i = parent[i]) first[i] = j;
  }
  for (int j = 0; j < n; ++j) {
    stop_now_and_then(j, task);
    if (parent[j] >= 0) --count[parent[j]];
    for (int e = begin[j]; e < begin[j + 1]; ++e) {
      const int i = row[e];
      // The diagonal, or j lies on a path that is already counted.
      if (i == j || first[j] <= reach[i]) continue;
      reach[i] = first[j];
      ++count[j];
      const int before = std::exchange(last_leaf[i], j);
      if (before < 0) continue;
      int q = before;  // where the paths from both leaves meet
      while (set[q] != q) q = set[q];
      for (int s = before; s != q;) s = std::exchange(set[s], q);
      --count[q];
    }
    if (parent[j] >= 0) set[j] = parent[j];
  }
  for (int j = 0; j < n; ++j)
    if (parent[j] >= 0) count[parent[j]] += count[j];
  return count;
}

/// First columns of supernodes: columns of one structure, then neighbours on the tree joined where
/// that adds few zeros.
std::vector<int> supernodes(const std::vector<int>& parent, const std::vector<int>& count) {
  const int n = parent.size();
  std::vector<int> children(n, 0), first;
  for (int j = 0; j < n; ++j)
    if (parent[j] >= 0) ++children[parent[j]];
  for (int j = 0; j < n; ++j)
    if (j == 0 || parent[j - 1] != j || count[j - 1] != count[j] + 1 || children[j] > 1)
      first.push_back(j);
  // From the last to the first: `open` is the supernode that ends where this one's columns end.
  struct Run {
    int first, columns, height;
    double zeros;
  };
  std::vector<Run> runs;
  for (std::size_t s = first.size(); s-- > 0;) {
    const int end = s + 1 < first.size() ? first[s + 1] : n;
    Run run{first[s], end - first[s], count[first[s]], 0};
    const bool chained = !runs.empty() && parent[end - 1] >= runs.back().first &&
                         parent[end - 1] < runs.back().first + runs.back().columns;
    if (chained) {
      const Run& next = runs.back();
      const int height = run.columns + next.height;
      const double zeros = next.zeros + double(run.columns) * (height - run.height);
      const double columns = run.columns + next.columns;
      const double share = zeros / (columns * (columns + 1) / 2 + columns * (height - columns));
      if (columns <= 4 || share == 0 || (columns <= 16 && share < 0.5) ||
          (columns <= 48 && share < 0.15) || share < 0.05) {
        runs.back() = {run.first, static_cast<int>(columns), height, zeros};
        continue;
      }
    }
    runs.push_back(run);
  }
  std::vector<int> merged;
  for (std::size_t r = runs.size(); r-- > 0;) merged.push_back(runs[r].first);
  merged.push_back(n);
  return merged;
}

}  // namespace

template <class Scalar>
Elimination::Elimination(const Eigen::SparseMatrix<Scalar>& lower, const Ordering& order,
                         const Task& task)
    : n(lower.cols()), old_of(order), new_of(order.size()) {
  const auto invert = [&] {
    for (int k = 0; k < n; ++k) new_of[old_of[k]] = k;
  };
  invert();
  Tree tree = elimination_tree(lower, new_of, task);
  entry_begin.assign(n + 1, 0);
  {
    // An unknown comes before its ancestors in any postorder, so entries stay in their columns.
    const auto post = postorder(tree.parent);
    stop_if_cancelled(task);
    std::vector<int> place(post.size());
    for (int k = 0; k < n; ++k) place[post[k]] = k;
    std::vector<int> parent_of(post.size());
    for (int k = 0; k < n; ++k) {
      old_of[k] = order[post[k]];
      entry_begin[k] = tree.entries[post[k]];
      const int up = tree.parent[post[k]];
      parent_of[k] = up < 0 ? -1 : place[up];
    }
    tree.parent = std::move(parent_of);
    invert();
  }
  sums_to_begins(entry_begin);
  entry_from.resize(entry_begin[n]);
  entry_row.resize(entry_from.size());  // rows of the matrix, for now
  {
    std::vector<int> at = entry_begin;
    for_entries(
        lower, new_of, task,
        [&](int a, int b) {
          const int to = at[std::min(a, b)];
          fetch_ahead(&entry_from.data()[to]);
          fetch_ahead(&entry_row.data()[to]);
        },
        [&](int e, int a, int b) {
          const int to = at[std::min(a, b)]++;
          entry_from[to] = b >= a ? e : ~e;
          entry_row[to] = std::max(a, b);
        });
  }
  first = supernodes(tree.parent, column_counts(entry_begin, entry_row, tree.parent, task));
  stop_if_cancelled(task);
  if (n == 0) first.assign(1, 0);
  n_super = int_size(first) - 1;
  super_of.resize(n);
  for (int s = 0; s < n_super; ++s)
    std::fill(super_of.begin() + first[s], super_of.begin() + first[s + 1], s);
  find_rows(task);
  place_entries(task);
  stop_if_cancelled(task);
  cut_into_tasks();
}

void Elimination::place_entries(const Task& task) {
  std::vector<int> place(n, 0);  // of rows among those of the supernode
  for (int s = 0; s < n_super; ++s) {
    stop_now_and_then(s, task);
    for (int k = 0; k < columns(s); ++k) place[first[s] + k] = k;
    int below_diagonal = columns(s);
    for (std::size_t r = rows_begin[s]; r < rows_begin[s + 1]; ++r)
      place[rows[r]] = below_diagonal++;
    for (int e = entry_begin[first[s]]; e < entry_begin[first[s + 1]]; ++e)
      entry_row[e] = place[entry_row[e]];
  }
}

void Elimination::find_rows(const Task& task) {
  parent.assign(n_super, -1);
  rows_begin.assign(1, 0);
  values_begin.assign(1, 0);
  std::vector<int> seen(n, -1), last_child(n_super, -1), sibling(n_super, -1);
  for (int s = 0; s < n_super; ++s) {
    stop_now_and_then(s, task);
    const int end = first[s + 1];
    const std::size_t start = rows.size();
    auto add = [&](int r) {
      if (r < end || seen[r] == s) return;
      seen[r] = s;
      rows.push_back(r);
    };
    for (int e = entry_begin[first[s]]; e < entry_begin[end]; ++e) add(entry_row[e]);
    for (int c = last_child[s]; c >= 0; c = sibling[c])
      for (std::size_t r = rows_begin[c]; r < rows_begin[c + 1]; ++r) add(rows[r]);
    std::sort(rows.begin() + start, rows.end());
    rows_begin.push_back(rows.size());
    values_begin.push_back(values_begin.back() + std::size_t(height(s)) * columns(s));
    if (rows.size() == start) continue;
    parent[s] = super_of[rows[start]];
    sibling[s] = std::exchange(last_child[parent[s]], s);
  }
  child_begin.assign(n_super + 1, 0);
  for (int s = 0; s < n_super; ++s)
    if (parent[s] >= 0) ++child_begin[parent[s]];
  sums_to_begins(child_begin);
  children.resize(child_begin[n_super]);
  std::vector<int> at = child_begin;
  for (int s = 0; s < n_super; ++s)
    if (parent[s] >= 0) children[at[parent[s]]++] = s;
  at_parent.resize(rows.size());
  parallel_for(std::size_t(n_super), supernode_grain, [&](std::size_t begin, std::size_t end) {
    stop_if_cancelled(task);
    for (std::size_t s = begin; s < end; ++s) {
      const int p = parent[s];
      if (p < 0) continue;
      std::size_t k = rows_begin[p];
      for (std::size_t r = rows_begin[s]; r < rows_begin[s + 1]; ++r) {
        if (rows[r] < first[p + 1]) {
          at_parent[r] = rows[r] - first[p];
          continue;
        }
        while (rows[k] != rows[r]) ++k;
        at_parent[r] = columns(p) + static_cast<int>(k - rows_begin[p]);
      }
    }
  });
}

double Elimination::flops() const {
  double sum = 0;
  for (int s = 0; s < n_super; ++s) {
    const double k = columns(s), m = below(s);
    sum += k * k * k / 6 + k * k * m / 2 + k * m * m / 2;
  }
  return sum;
}

void Elimination::cut_into_tasks() {
  // Subtrees of up to 1/32 of all work are a task each; what is above them goes one by one.
  std::vector<double> work(n_super, 0.0);
  std::vector<int> subtree_first(n_super);
  double total = 0;
  for (int s = 0; s < n_super; ++s) subtree_first[s] = s;
  for (int s = 0; s < n_super; ++s) {
    const double k = columns(s), m = below(s), own = 2000 + k * (k + m) * (k + m);
    work[s] += own;
    total += own;
    if (parent[s] < 0) continue;
    work[parent[s]] += work[s];
    subtree_first[parent[s]] = std::min(subtree_first[parent[s]], subtree_first[s]);
  }
  const double enough = std::max(total / 32, 2e6);
  task_of.assign(n_super, -1);
  for (int s = n_super; s-- > 0;) {
    const int begin = work[s] <= enough ? subtree_first[s] : s;
    task_first.push_back(begin);
    task_parent.push_back(s);
    s = begin;
  }
  std::reverse(task_first.begin(), task_first.end());
  std::reverse(task_parent.begin(), task_parent.end());  // the task's last supernode, for now
  task_first.push_back(n_super);
  for (int t = 0; t < n_tasks(); ++t)
    std::fill(task_of.begin() + task_first[t], task_of.begin() + task_first[t + 1], t);
  target.resize(rows.size());
  parallel_for(std::size_t(n_tasks()), 1, [&](std::size_t t, std::size_t) {
    const int root = task_parent[t];
    const auto begin = rows.begin() + index(rows_begin[root]);
    const auto end = rows.begin() + index(rows_begin[root + 1]);
    for (std::size_t r = rows_begin[task_first[t]]; r < rows_begin[root + 1]; ++r)
      target[r] = rows[r] < first[root + 1]
                      ? rows[r]
                      : ~static_cast<int>(std::lower_bound(begin, end, rows[r]) - begin);
  });
  for (int& t : task_parent) t = parent[t] < 0 ? -1 : task_of[parent[t]];
}

template Elimination::Elimination(const SpMat&, const Ordering&, const Task&);
template Elimination::Elimination(const SpMatC&, const Ordering&, const Task&);

}  // namespace littoral
