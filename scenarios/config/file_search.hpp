#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ironbird::scenarios {

/// Where what a file names is looked for, in this order: in the file's own folder and every folder above it,
/// in Ironbird's own tree, in the working folder and every folder above it. So a scenario finds its
/// neighbours wherever it lies, and the models that ship wherever it is started from.
/// @param named_in  the file that says the name; it need not exist
std::vector<std::filesystem::path> search_folders(const std::filesystem::path& named_in);

/// The first `name` in these folders that exists. An absolute name stands for itself.
/// @param inner  a file that it must hold, which makes it a folder of the kind that is wanted; may be empty
/// @return an empty path when there is none
std::filesystem::path find_named(const std::string& name, const std::vector<std::filesystem::path>& folders,
                                 const std::string& inner = "");

/// Where the scenarios that ship are.
std::filesystem::path library_folder();

/// The path as a reader would write it: from the working folder when it lies below it.
std::filesystem::path readable(const std::filesystem::path& path);

}  // namespace ironbird::scenarios
