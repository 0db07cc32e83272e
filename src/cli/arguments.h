#pragma once
// The words after the program's name, before they are parsed.

#include <string>
#include <vector>

#include "cli/session.h"

namespace littoral::cli {

/// Options of which "on" is one of several words may stand without a word, and are joined to the
/// one that follows or to "on" by "=". Lists of numbers, 10 1500 3000, "10, 1500" or 10,1500,3000,
/// become one list with commas. Throws InputError for a list with nothing between two commas.
std::vector<std::string> expanded_arguments(const CLI::App& program,
                                            std::vector<std::string> words);
/// What is to be said of words that are lists but may have been meant as one number: "0,5".
std::vector<std::string> doubtful_lists(const CLI::App& program,
                                        const std::vector<std::string>& words);

/// Runs another verb for each of many inputs, with options of that verb between its own.
inline constexpr const char* batch_verb = "batch";
inline constexpr const char* default_batch_verb = "sdf";
/// The words without options that `other` may have and `own` has not, which are added to `of_other`
/// as one word each: "--name=value".
std::vector<std::string> separate_words(const CLI::App& own, const CLI::App& other,
                                        const std::vector<std::string>& words,
                                        std::vector<std::string>& of_other);
/// The same for a run of `batch`. Throws InputError for a verb or an option that there is not.
std::vector<std::string> without_words_of_verb(const CLI::App& program,
                                               std::vector<std::string> words,
                                               std::vector<std::string>& of_verb);

/// Throws InputError for a verb or an option that there is not, naming the nearest, and for options
/// without their value. "-s=FILE" becomes "-sFILE". Returns the outputs that are named.
std::vector<std::string> check_names(const CLI::App& program, std::vector<std::string>& arguments);
/// What is wrong with arguments that do not parse, and what to do; its code.
std::string refused_text(const CLI::ParseError& error, CLI::App& program,
                         const std::vector<std::string>& arguments, std::string& code);

/// All verbs in their order.
std::vector<CLI::App*> verbs_of(CLI::App& program);
std::vector<const CLI::App*> verbs_of(const CLI::App& program);
std::vector<std::string> verb_names(const CLI::App& program);
/// The verb of this name. Throws InputError naming the nearest.
const CLI::App& verb_named(const CLI::App& program, const std::string& name);

/// What --help says: of the program where there is no verb of this name. The options of methods
/// are left out unless all are wanted.
std::string help_text(CLI::App& program, const std::string& verb, bool all);

}  // namespace littoral::cli
