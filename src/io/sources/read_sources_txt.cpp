// The two .txt formats for curves and points on a mesh.

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "base/counted.h"
#include "io/sources/source_nodes.h"
#include "io/text_scan.h"
#include "littoral/error.h"

namespace littoral::io {
namespace {

constexpr std::string_view keywords = "signed_curve, unsigned_curve or unsigned_point";

bool is_keyword(std::string_view word) {
  return word == "signed_curve" || word == "unsigned_curve" || word == "unsigned_point";
}

// Numbers until the end of the line (or a comment glued to a number's right).
std::vector<std::string_view> rest_of_line(LineScanner& scan) {
  std::vector<std::string_view> words;
  for (auto word = scan.word(); !word.empty(); word = scan.word()) {
    if (word[0] == '#') break;
    words.push_back(word);
  }
  return words;
}

std::int64_t index_of(const LineScanner& scan, std::string_view word) {
  const auto index = parse_integer(word);
  if (!index) scan.fail("expected an index, found " + in_quotes(word));
  return *index;
}

double number_of(const LineScanner& scan, std::string_view word) {
  const auto number = parse_double(word);
  if (!number) scan.fail("expected a number, found " + in_quotes(word));
  return *number;
}

// v i | e i t | e i j t | f i a b | f i a b c, after the letter; false for another letter.
bool read_node(const LineScanner& scan, const NodeMaker& make, std::string_view letter,
               const std::vector<std::string_view>& words, int base, SurfacePoint& node) {
  const std::size_t n = words.size();
  if (letter == "v") {
    if (n != 1) scan.fail("expected 'v INDEX'");
    node = make.vertex(index_of(scan, words[0]), base);
  } else if (letter == "e") {
    if (n != 2 && n != 3) scan.fail("expected 'e EDGE T' or 'e VERTEX VERTEX T'");
    const std::int64_t first = index_of(scan, words[0]);
    const double t = number_of(scan, words[n - 1]);
    node = n == 2 ? make.edge(first, t, base) : make.edge(first, index_of(scan, words[1]), t, base);
  } else if (letter == "f") {
    if (n != 3 && n != 4) scan.fail("expected 'f FACE A B' or 'f FACE A B C'");
    const double a = number_of(scan, words[1]), b = number_of(scan, words[2]);
    const double c = n == 4 ? number_of(scan, words[3]) : 1 - a - b;
    node = make.face(index_of(scan, words[0]), {a, b, c}, base);
  } else {
    return false;
  }
  return true;
}

// Signed-heat format: a keyword line, then the nodes of its curve or its points.
class SignedHeatReader {
 public:
  SignedHeatReader(std::string_view bytes, const std::string& name, const SurfaceMesh& mesh,
                   std::optional<int> base)
      : scan_(bytes, name, '#'),
        name_(name),
        make_(mesh, [this] { return here(scan_.line()); }),
        base_(base.value_or(0)),
        line_base_(base.value_or(1)) {}

  Sources read() {
    while (scan_.next()) {
      const std::string_view word = scan_.word();
      if (is_keyword(word)) {
        finish();
        begin(word);
      } else if (word == "v" || word == "e" || word == "f" || word == "l") {
        if (keyword_.empty()) {
          scan_.fail("node before any keyword (" + std::string(keywords) + ")");
        }
        if (nodes_.empty()) first_line_ = scan_.line();
        add(word, rest_of_line(scan_));
      } else {
        scan_.fail("unknown keyword " + in_quotes(word) + ", expected " + std::string(keywords));
      }
    }
    finish();
    return std::move(sources_);
  }

 private:
  std::string here(std::size_t line) const { return name_ + ":" + std::to_string(line); }

  void begin(std::string_view keyword) {
    keyword_ = keyword;
    keyword_line_ = scan_.line();
    auto flags = rest_of_line(scan_);
    value_ = 0;
    if (flags.size() >= 2 && flags[flags.size() - 2] == "value") {
      value_ = number_of(scan_, flags.back());
      if (!std::isfinite(value_)) scan_.fail("the value is not finite");
      flags.resize(flags.size() - 2);
    }
    reversed_ = flags.size() == 1 && flags[0] == "1";
    if (flags.size() > 1 || (flags.size() == 1 && flags[0] != "0" && flags[0] != "1")) {
      scan_.fail("after " + std::string(keyword) +
                 " only 0 or 1 (reversed) and 'value NUMBER' may follow, found " +
                 in_quotes(flags.back()));
    }
  }

  void add(std::string_view letter, const std::vector<std::string_view>& words) {
    if (letter == "l") {
      if (words.empty()) scan_.fail("expected 'l INDEX ...'");
      for (std::string_view word : words) {
        nodes_.push_back(make_.vertex(index_of(scan_, word), line_base_));
      }
      return;
    }
    SurfacePoint node;
    read_node(scan_, make_, letter, words, base_, node);
    nodes_.push_back(node);
  }

  void finish() {
    if (keyword_.empty()) return;
    const bool points = keyword_ == "unsigned_point";
    const std::size_t needed = points ? 1 : 2;
    if (nodes_.size() < needed) {
      scan_.fail_at(keyword_line_, keyword_ + " has " + counted(nodes_.size(), "node", "nodes") +
                                       ", at least " + std::to_string(needed) +
                                       (points ? " is needed" : " are needed"));
    }
    if (points) {
      for (const SurfacePoint& node : nodes_) sources_.add(node, value_);
    } else {
      if (reversed_) std::reverse(nodes_.begin(), nodes_.end());
      sources_.curves.push_back({nodes_, keyword_ == "signed_curve", here(first_line_), value_});
    }
    nodes_.clear();
  }

  LineScanner scan_;
  const std::string& name_;
  NodeMaker make_;
  int base_, line_base_;
  Sources sources_;
  std::string keyword_;
  std::size_t keyword_line_ = 0, first_line_ = 0;
  bool reversed_ = false;
  double value_ = 0;
  std::vector<SurfacePoint> nodes_;
};

// Surface-winding-number format: points (v, e), segments between them (l), and chains of faces (c).
// Points are numbered as they come; a segment may name points that come later. `n` lines separate
// curves and say nothing.
class WindingReader {
 public:
  WindingReader(std::string_view bytes, const std::string& name, const SurfaceMesh& mesh,
                std::optional<int> base)
      : bytes_(bytes),
        name_(name),
        scan_(bytes, name, '\0'),
        make_(mesh, [this] { return here(scan_.line()); }),
        base_(base ? *base : written_base()) {}

  Sources read() {
    while (scan_.next()) {
      const std::string_view word = scan_.word();
      if (word[0] == '#' || word == "n") continue;
      read_record(word, rest_of_line(scan_));
    }
    if (segments_.empty() && !points_.empty()) {
      scan_.fail_at(lines_[0], "nodes with neither a keyword line (" + std::string(keywords) +
                                   ") nor segments (l)");
    }
    return curves();
  }

 private:
  std::string here(std::size_t line) const { return name_ + ":" + std::to_string(line); }

  // The comment "#offset 0" makes all indices count from 0, wherever it stands.
  int written_base() const {
    LineScanner scan(bytes_, name_, '\0');
    while (scan.next()) {
      if (scan.word() != "#offset") continue;
      const std::int64_t offset = scan.integer("0 or 1 after #offset");
      if (offset != 0 && offset != 1) scan.fail("expected 0 or 1 after #offset");
      return static_cast<int>(offset);
    }
    return 1;
  }

  void read_record(std::string_view letter, const std::vector<std::string_view>& words) {
    SurfacePoint point;
    if (letter == "l") {
      if (words.size() != 2) scan_.fail("expected 'l POINT POINT'");
      segments_.emplace_back(index_of(scan_, words[0]), index_of(scan_, words[1]));
      segment_lines_.push_back(scan_.line());
    } else if (letter == "c") {
      if (words.size() < 2) scan_.fail("expected 'c FACE FACE ...'");
      FaceChain& chain = chains_.emplace_back(FaceChain{{}, here(scan_.line())});
      for (std::string_view word : words)
        chain.faces.push_back(make_.whole_face(index_of(scan_, word), base_));
    } else if (read_node(scan_, make_, letter, words, base_, point)) {
      points_.push_back(point);
      lines_.push_back(scan_.line());
    } else {
      scan_.fail("unknown record " + in_quotes(letter) + ", expected v, e, l or c, or a keyword (" +
                 std::string(keywords) + ")");
    }
  }

  int point(std::int64_t written, std::size_t line) const {
    if (written < base_ || written - base_ >= static_cast<std::int64_t>(points_.size())) {
      scan_.fail_at(line, "segment refers to point " + std::to_string(written) + ", the file has " +
                              std::to_string(points_.size()) + " (counted from " +
                              std::to_string(base_) + ")");
    }
    return static_cast<int>(written - base_);
  }

  Sources curves() const {
    // A place written several times is one point: some files repeat it for every segment.
    std::map<std::tuple<int, int, double, double>, int> first;
    std::vector<int> same;
    for (const SurfacePoint& p : points_) {
      const std::tuple key(static_cast<int>(p.on), p.element, p.b[0], p.b[1]);
      same.push_back(first.try_emplace(key, static_cast<int>(same.size())).first->second);
    }
    std::vector<Segment> segments;
    for (std::size_t s = 0; s < segments_.size(); ++s) {
      const int a = point(segments_[s].first, segment_lines_[s]);
      const int b = point(segments_[s].second, segment_lines_[s]);
      segments.emplace_back(same[a], same[b]);
    }
    Sources sources;
    for (const auto& line : chain(segments, static_cast<int>(points_.size()))) {
      Curve curve;
      for (int p : line) curve.nodes.push_back(points_[p]);
      curve.origin = here(lines_[line[0]]);
      sources.curves.push_back(std::move(curve));
    }
    sources.chains = chains_;
    return sources;
  }

  std::string_view bytes_;
  const std::string& name_;
  LineScanner scan_;
  NodeMaker make_;
  int base_;
  std::vector<SurfacePoint> points_;
  std::vector<std::size_t> lines_, segment_lines_;
  std::vector<std::pair<std::int64_t, std::int64_t>> segments_;
  std::vector<FaceChain> chains_;
};

bool has_keyword(std::string_view bytes, const std::string& name) {
  LineScanner scan(bytes, name, '#');
  while (scan.next()) {
    if (is_keyword(scan.word())) return true;
  }
  return false;
}

}  // namespace

Sources read_sources_txt(std::string_view bytes, const std::string& name, const SurfaceMesh& mesh,
                         std::optional<int> index_base) {
  const std::string_view text = without_byte_order_mark(bytes, name);
  return has_keyword(text, name) ? SignedHeatReader(text, name, mesh, index_base).read()
                                 : WindingReader(text, name, mesh, index_base).read();
}

}  // namespace littoral::io
