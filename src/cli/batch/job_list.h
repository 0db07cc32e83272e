#pragma once
// JOBS of `littoral batch`: a folder, a pattern, a list or one file.

#include <filesystem>
#include <string>
#include <vector>

namespace littoral::cli {

/// An input, and the words of its line where it stands in a list.
struct ListedJob {
  std::string input, name;         // name: of its results, below the folder
  std::vector<std::string> words;  // "--resolution=64"; verb, extensions and name among them
  std::string line;                // "jobs.csv:7: ", empty without a list
};

/// The inputs that JOBS names, sorted unless they are a list:
///   a folder       all files below it that may be inputs; `without`, a folder, is left out
///   a pattern      the files that match * ? [...]
///   .txt           a line for each input, with options after it; quotes hold spaces together
///   .csv           a column "input", and one for each option
///   .jsonl         an object for each input: "input", and options; lists are repeated options
///   another file   that one
/// Names are the paths below the folder, the fixed part of the pattern, or as written in the list,
/// without extension; where two had one name they keep theirs. Throws InputError naming list and
/// line, and where there are no inputs.
std::vector<ListedJob> listed_jobs(const std::string& jobs, const std::filesystem::path& without);

}  // namespace littoral::cli
