#include "cli/verbs/manual.h"

#include <algorithm>
#include <cctype>

#include "base/messages.h"
#include "cli/arguments.h"
#include "cli/input/method_options.h"
#include "cli/session.h"

namespace littoral::cli {

namespace {

/// Text that roff shows as it is.
std::string roff(const std::string& text) {
  std::string out;
  bool begins = true;
  for (const char c : text) {
    if (begins && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
    begins = c == '\n';
  }
  return out;
}

std::string page_head(const std::string& name, const std::string& about) {
  std::string title = name;
  std::transform(title.begin(), title.end(), title.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return ".TH " + roff(title) +
         " 1 \"\" \"littoral " LITTORAL_VERSION "\" \"littoral\"\n.SH NAME\n" + roff(name) +
         " \\- " + roff(about) + "\n";
}

/// A term and what it means.
std::string entry(const std::string& term, const std::string& meaning) {
  return ".TP\n\\fB" + roff(term) + "\\fR\n" + roff(meaning) + "\n";
}

std::string option_entry(const CLI::Option& option) {
  const std::string value = option.get_type_name();
  std::string term = option.get_name(option.get_positional(), true);
  for (std::size_t at = 0; (at = term.find(',', at)) != std::string::npos; at += 2)
    term.insert(at + 1, " ");
  if (!value.empty()) term += " " + value;
  return entry(term, option.get_description() +
                         (option.get_required() && !option.get_positional() ? "; required" : ""));
}

/// The options under a heading of --help; nothing where there are none.
template <class Belongs>
std::string options_section(const CLI::App& verb, const std::string& title,
                            const Belongs& belongs) {
  std::string text;
  for (const CLI::Option* option : verb.get_options())
    if (belongs(*option)) text += option_entry(*option);
  return text.empty() ? "" : ".SH " + title + "\n" + text;
}

std::string exit_statuses() {
  return ".SH EXIT STATUS\n" + entry("0", "done") +
         entry("1", "the computation failed, or a result could not be written") +
         entry("2", "bad usage or bad input") +
         entry("130", "interrupted; no half-written file is left");
}

std::string synopsis(const CLI::App& verb) {
  std::string text = ".SH SYNOPSIS\n\\fBlittoral " + roff(verb.get_name()) + "\\fR";
  for (const CLI::Option* option : verb.get_options()) {
    if (!option->get_positional()) continue;
    const std::string name = roff(option->get_name(true, true));
    text += option->get_required() ? " " + name : " [" + name + "]";
  }
  for (const CLI::Option* option : verb.get_options())
    if (option->get_required() && !option->get_positional())
      text += " " + roff(option->get_name(false, false) + " " + option->get_type_name());
  return text + " [options]\n";
}

}  // namespace

std::string manual_page(const CLI::App& program) {
  std::string text = page_head("littoral", "distance and inside/outside for broken geometry");
  text += ".SH SYNOPSIS\n\\fBlittoral\\fR VERB [arguments]\n.SH DESCRIPTION\n";
  text += roff(program.get_description()) + "\n.PP\n" +
          roff(
              "Each verb has a page of its own, littoral-VERB(1), and littoral help VERB prints "
              "its options. Errors and warnings are one line each on standard error and end with "
              "a code in brackets.") +
          "\n.SH VERBS\n";
  for (const CLI::App* verb : verbs_of(program))
    text += entry(verb->get_name(), verb->get_description());
  text += exit_statuses();
  for (const auto& [kind, title] :
       {std::pair(Message::Kind::error, "ERRORS"), std::pair(Message::Kind::warning, "WARNINGS")}) {
    text += std::string(".SH ") + title + "\n";
    for (const Message& message : messages())
      if (message.kind == kind)
        text += entry(message.code, std::string(message.about) + ": " + message.meaning + ". " +
                                        message.remedy + ".");
  }
  return text;
}

std::string manual_page(const CLI::App& program, const CLI::App& verb) {
  const auto is_helping = [&](const CLI::Option& option) {
    return &option == verb.get_help_ptr() || &option == verb.get_help_all_ptr();
  };
  const auto is_common = [&](const CLI::Option& option) {
    return option.get_group() == common_options_group || is_helping(option);
  };
  const auto is_of_methods = [](const CLI::Option& option) {
    return option.get_group() == method_options_group;
  };
  return page_head("littoral-" + verb.get_name(), verb.get_description()) + synopsis(verb) +
         options_section(verb, "ARGUMENTS",
                         [](const CLI::Option& option) { return option.get_positional(); }) +
         options_section(verb, "OPTIONS",
                         [&](const CLI::Option& option) {
                           return !option.get_positional() && !is_common(option) &&
                                  !is_of_methods(option);
                         }) +
         options_section(verb, "OPTIONS OF METHODS", is_of_methods) +
         options_section(verb, "COMMON OPTIONS", is_common) + exit_statuses() + ".SH SEE ALSO\n" +
         roff(program.get_name() + "(1)") + "\n";
}

}  // namespace littoral::cli
