#include <charconv>
#include <cmath>

#include "littoral/error.h"
#include "methods/tori/torus_fit.h"

namespace littoral {

std::string_view torus_fit_weights();  // made by CMake from python/torus_fit.txt

namespace {

constexpr float limit = 6, largest = 1e4f;

/// Numbers of a text one after the other; lines that begin with # are left out.
class Numbers {
 public:
  Numbers(std::string_view text, const std::string& file) : left_(text), file_(file) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(file_ + ": not the weights of a torus fit: " + what, "bad-file");
  }
  std::string_view word() {
    for (;;) {
      const std::size_t start = left_.find_first_not_of(" \t\r\n");
      if (start == std::string_view::npos) return {};
      left_.remove_prefix(start);
      if (left_.front() != '#') break;
      left_.remove_prefix(std::min(left_.find('\n'), left_.size()));
    }
    const std::size_t end = std::min(left_.find_first_of(" \t\r\n"), left_.size());
    const std::string_view out = left_.substr(0, end);
    left_.remove_prefix(end);
    return out;
  }
  float number() {
    const std::string_view w = word();
    if (w.empty()) fail("the file ends early");
    float x = 0;
    const auto [end, error] = std::from_chars(w.data(), w.data() + w.size(), x);
    if (error != std::errc() || end != w.data() + w.size() || !(std::abs(x) <= largest))
      fail(std::string("'").append(w.substr(0, 40)).append("' is no number up to 1e4"));
    return x;
  }
  template <class Layer>
  void read(Layer& layer) {
    const auto rows = layer.matrix.rows(), columns = layer.matrix.cols();
    if (number() != static_cast<float>(rows) || number() != static_cast<float>(columns))
      fail("a layer is not " + std::to_string(rows) + " x " + std::to_string(columns));
    for (Eigen::Index i = 0; i < rows; ++i)
      for (Eigen::Index j = 0; j < columns; ++j) layer.matrix(i, j) = number();
    for (Eigen::Index i = 0; i < rows; ++i) layer.offset[i] = number();
  }

 private:
  std::string_view left_;
  const std::string& file_;
};

}  // namespace

LearnedFit LearnedFit::parse(std::string_view text, const std::string& file) {
  Numbers numbers(text, file);
  if (numbers.word() != "littoral-torus-fit" || numbers.word() != "1")
    numbers.fail("it does not begin with 'littoral-torus-fit 1'");
  LearnedFit out;
  numbers.read(out.first_);
  numbers.read(out.context_);
  numbers.read(out.second_);
  numbers.read(out.neighbour_);
  numbers.read(out.point_);
  if (!numbers.word().empty()) numbers.fail("more follows after the last layer");
  return out;
}

std::shared_ptr<const LearnedFit> LearnedFit::built_in() {
  static const auto fit =
      std::make_shared<const LearnedFit>(parse(torus_fit_weights(), "python/torus_fit.txt"));
  return fit;
}

LearnedFit::Factors LearnedFit::operator()(const Features& seen) const {
  using Hidden = Eigen::Matrix<float, hidden, neighbours>;
  using Vector = Eigen::Matrix<float, hidden, 1>;
  const Hidden h = ((first_.matrix.lazyProduct(seen)).colwise() + first_.offset).cwiseMax(0.0f);
  const Vector mean = h.rowwise().mean(), most = h.rowwise().maxCoeff();
  const Vector context = (context_.matrix.leftCols<hidden>() * mean +
                          context_.matrix.rightCols<hidden>() * most + context_.offset)
                             .cwiseMax(0.0f);
  const Vector shared = second_.matrix.rightCols<hidden>() * context + second_.offset;
  const Hidden g =
      ((second_.matrix.leftCols<hidden>().lazyProduct(h)).colwise() + shared).cwiseMax(0.0f);
  const auto clipped = [](const auto& x) { return x.cwiseMax(-limit).cwiseMin(limit); };
  Factors out;
  out.of_neighbours = clipped((neighbour_.matrix.lazyProduct(g)).colwise() + neighbour_.offset);
  const Eigen::Matrix<float, 2, 1> own = clipped(point_.matrix * context + point_.offset);
  out.of_point = own[0];
  out.of_torus = own[1];
  return out;
}

}  // namespace littoral
