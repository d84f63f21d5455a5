#pragma once
#include <filesystem>
#include <string_view>

namespace layerloop {

/// Makes what was written to `temporary` durable and gives it its final name: fsync(file), rename, fsync(folder).
/// A kill at any moment leaves the old file or the new one, never a part. \throws FileError
void commit_file(std::filesystem::path const& temporary, std::filesystem::path const& path);

/// Name to write to before commit_file: beside the file, so that the rename stays on one file system.
std::filesystem::path temporary_name(std::filesystem::path const& path);

/// Writes text aside and renames it. \throws FileError
void write_file(std::filesystem::path const& path, std::string_view text);

/// Whole file as text. \throws FileError
std::string read_file(std::filesystem::path const& path);

}  // namespace layerloop
