#include "io/xml_tags.h"

#include "littoral/error.h"

namespace littoral::io {

namespace {

std::string plain_text(std::string_view text) {
  static const std::pair<std::string_view, char> entities[] = {
      {"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}};
  std::string plain;
  while (!text.empty()) {
    bool found = false;
    for (const auto& [entity, c] : entities) {
      if (text.substr(0, entity.size()) != entity) continue;
      plain += c;
      text.remove_prefix(entity.size());
      found = true;
      break;
    }
    if (found) continue;
    plain += text.front();
    text.remove_prefix(1);
  }
  return plain;
}

bool is_xml_space(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

}  // namespace

bool XmlTag::has(std::string_view key) const {
  for (const auto& [held, value] : attributes)
    if (held == key) return true;
  return false;
}

std::string XmlTag::attribute(std::string_view key, const std::string& fallback) const {
  for (const auto& [held, value] : attributes)
    if (held == key) return plain_text(value);
  return fallback;
}

std::string_view XmlTag::local_name() const {
  const bool closes = name.starts_with('/');
  const std::size_t colon = name.find(':');
  if (colon == std::string_view::npos) return name;
  return closes ? name : name.substr(colon + 1);
}

void XmlTags::fail(const std::string& what) const {
  throw InputError(name_ + ": " + what, "bad-file");
}

bool XmlTags::next(std::size_t at, XmlTag& tag) const {
  for (;;) {
    at = bytes_.find('<', at);
    if (at == std::string_view::npos) return false;
    if (bytes_.substr(at, 4) == "<!--") {
      at = bytes_.find("-->", at);
      if (at == std::string_view::npos) return false;
    } else if (bytes_.substr(at, 2) == "<?" || bytes_.substr(at, 2) == "<!") {
      at = bytes_.find('>', at);
      if (at == std::string_view::npos) return false;
    } else {
      break;
    }
  }
  tag.attributes.clear();
  tag.empty = false;
  const auto peek = [&] { return at < bytes_.size() ? bytes_[at] : '>'; };
  const std::size_t begin = ++at;
  while (peek() != '>' && !is_xml_space(peek()) && !(peek() == '/' && at > begin)) ++at;
  tag.name = bytes_.substr(begin, at - begin);
  for (;;) {
    while (is_xml_space(peek())) ++at;
    if (at >= bytes_.size()) fail("the XML ends within a tag");
    if (peek() == '>') break;
    if (peek() == '/') {
      tag.empty = true;
      ++at;
      continue;
    }
    const std::size_t equals = bytes_.find('=', at);
    if (equals == std::string_view::npos) fail("an XML attribute has no value");
    std::string_view key = bytes_.substr(at, equals - at);
    while (!key.empty() && is_xml_space(key.back())) key.remove_suffix(1);
    at = equals + 1;
    while (is_xml_space(peek())) ++at;
    const char quote = peek();
    const std::size_t close = bytes_.find(quote, at + 1);
    if ((quote != '"' && quote != '\'') || close == std::string_view::npos)
      fail("an XML attribute has no quotes");
    tag.attributes.emplace_back(key, bytes_.substr(at + 1, close - at - 1));
    at = close + 1;
  }
  tag.end = at + 1;
  return true;
}

}  // namespace littoral::io
