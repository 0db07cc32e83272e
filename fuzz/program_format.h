#pragma once
// One program per kind of file, called by one name per format: fuzz_obj, fuzz_npy_cloud, ...

#include <string>

/// The extension in the name that this program was called by: ".npy" of fuzz_npy_cloud.
const std::string& program_format();
