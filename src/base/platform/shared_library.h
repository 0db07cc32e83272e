#pragma once
// Code that is looked for at run time.

#include <filesystem>
#include <string>

namespace littoral {

/// The folder of the program or shared library that this code is part of; empty where the system
/// does not say.
std::filesystem::path own_folder();

/// The address of `symbol` in a shared library, which is loaded and stays so; null where the
/// library does not load or has no such symbol.
void* symbol_of_library(const std::filesystem::path& library, const std::string& symbol);

/// The address of `symbol` in what is loaded already; null where there is none.
void* loaded_symbol(const std::string& symbol);

}  // namespace littoral
