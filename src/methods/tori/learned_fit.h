#pragma once
// A small network that says how much each neighbour counts when a torus is fitted; trained by
// python/train_torus_fit.py.

#include <Eigen/Core>
#include <memory>
#include <string>
#include <string_view>

namespace littoral {

/// Layers of the network. What it sees does not change under rotation, translation and scale.
/// Immutable, may be asked from several threads.
class LearnedFit {
 public:
  static constexpr int neighbours = 16, features = 8, hidden = 24;
  using Features = Eigen::Matrix<float, features, neighbours>;  // one neighbour a column

  /// Logarithms of factors.
  struct Factors {
    Eigen::Matrix<float, 2, neighbours> of_neighbours;  // on the equations of height, of normal
    float of_point, of_torus;  // on that of the point itself; on the torus in the blend
  };

  /// Layers as train_torus_fit.py writes them. Throws InputError naming `file` and what is wrong if
  /// sizes are others than these, a number is missing, not finite or beyond 1e4, or more follows.
  static LearnedFit parse(std::string_view text, const std::string& file);

  /// The one that comes with the library.
  static std::shared_ptr<const LearnedFit> built_in();

  Factors operator()(const Features& seen) const;

 private:
  template <int outputs, int inputs>
  struct Layer {
    Eigen::Matrix<float, outputs, inputs> matrix;
    Eigen::Matrix<float, outputs, 1> offset;
  };
  Layer<hidden, features> first_;      // of a neighbour
  Layer<hidden, 2 * hidden> context_;  // of their means and largest ones
  Layer<hidden, 2 * hidden> second_;   // of a neighbour in its context
  Layer<2, hidden> neighbour_, point_;
};

}  // namespace littoral
