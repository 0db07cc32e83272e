#pragma once
// What a sparse factorization A = L L^* knows before it sees a number: the elimination tree, its
// supernodes, and which parts of the work may run side by side.

#include <memory>
#include <vector>

#include "solve/direct/ordering.h"

namespace littoral {

/// The structure of the factor of a symmetric matrix. Unknowns are renumbered in the order of their
/// elimination, columns with (almost) the same rows below them form supernodes: supernode s is the
/// columns first[s] .. first[s+1] and the `rows` below these. The rows of a supernode are among the
/// columns and rows of its parent; a supernode comes after its children. Immutable.
struct Elimination {
  /// lower: the matrix's lower triangle; only its pattern is looked at. Throws Cancelled.
  template <class Scalar>
  Elimination(const Eigen::SparseMatrix<Scalar>& lower, const Ordering& order,
              const Task& task = {});

  int n = 0, n_super = 0;
  std::vector<int> old_of, new_of;         // unknowns: old_of[new number], new_of[old number]
  std::vector<int> first;                  // supernodes + 1
  std::vector<int> parent;                 // supernodes; -1: a root
  std::vector<std::size_t> rows_begin;     // supernodes + 1
  std::vector<int> rows;                   // of all supernodes, ascending in each
  std::vector<int> at_parent;              // per entry of rows: its place among the parent's
  std::vector<std::size_t> values_begin;   // supernodes + 1: where its block of the factor starts
  std::vector<int> super_of;               // columns
  std::vector<int> child_begin, children;  // children of s: children[child_begin[s] ...], ascending

  // Where entry e of the given lower triangle goes: column by column of the renumbered matrix.
  std::vector<int> entry_begin;  // columns + 1
  std::vector<int> entry_from;   // index among the given values; ~index where it is transposed
  std::vector<int> entry_row;    // its place among the supernode's columns and rows

  // Tasks: runs of supernodes that form whole subtrees, small ones together, big ones alone.
  std::vector<int> task_first;   // tasks + 1, supernodes
  std::vector<int> task_parent;  // tasks
  std::vector<int> task_of;      // supernodes
  std::vector<int> target;       // per entry of rows: the column if it belongs to the same task,
                                 //   else ~(place among the rows of the task's last supernode)

  int columns(int s) const { return first[s + 1] - first[s]; }
  int below(int s) const { return rows_begin[s + 1] - rows_begin[s]; }
  int height(int s) const { return columns(s) + below(s); }
  std::size_t values() const { return values_begin[n_super]; }
  int n_tasks() const { return task_parent.size(); }
  double flops() const;  // multiply-adds of the factorization

 private:
  void find_rows(const Task& task);
  void place_entries(const Task& task);
  void cut_into_tasks();
};

extern template Elimination::Elimination(const SpMat&, const Ordering&, const Task&);
extern template Elimination::Elimination(const SpMatC&, const Ordering&, const Task&);

}  // namespace littoral
