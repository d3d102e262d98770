#include "base/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "base/descriptors.h"
#include "base/errors.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

Error cannot_write(const fs::path& path, const std::string& what) {
  return output_error(path, "cannot write: " + what,
                      "choose a folder that exists, has space and that you may write to");
}

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// Calls `make` with names in `folder` until one is new: that name, or nothing (errno says why).
template <typename Make>
fs::path with_new_name(const fs::path& folder, const Make& make) {
  static std::atomic<unsigned> counter = 0;
  constexpr int kTries = 1000;  // names that killed processes left behind
  for (int i = 0; i < kTries; ++i) {
    fs::path path = folder / (".ukemi-" + std::to_string(getpid()) + '-' + std::to_string(counter++));
    if (make(path.c_str())) return path;
    if (errno != EEXIST) break;
  }
  return {};
}

/// Gives a name to a file that has none.
bool link_as(int fd, const char* path) {
  const std::string self = "/proc/self/fd/" + std::to_string(fd);
  return linkat(AT_FDCWD, self.c_str(), AT_FDCWD, path, AT_SYMLINK_FOLLOW) == 0;
}

/// A link stays a link: what it leads to is written.
fs::path followed(const fs::path& path) {
  std::error_code error;
  fs::path target = fs::canonical(path, error);
  return error ? path : target;
}

}  // namespace

Result<std::vector<std::uint8_t>> read_file(const fs::path& path, std::size_t max_bytes) {
  struct stat info {};
  if (stat(path.c_str(), &info) != 0)
    return input_error(path, std::string("cannot read: ") + std::strerror(errno),
                       "check the file's name and folder");
  if (!S_ISREG(info.st_mode))
    return input_error(path, S_ISDIR(info.st_mode) ? "is a directory" : "is not a regular file",
                       "name a file");
  if (static_cast<std::size_t>(info.st_size) > max_bytes)
    return input_error(
        path, "has " + std::to_string(info.st_size) + " bytes; the limit is " + std::to_string(max_bytes),
        "use a smaller file");
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0)
    return input_error(path, std::string("cannot read: ") + std::strerror(errno),
                       "check the file's permissions");
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(info.st_size));
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::read(fd, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    done += static_cast<std::size_t>(n);
  }
  close(fd);
  if (done != bytes.size())
    return input_error(path, "cannot read the whole file", "copy it to another disk and try again");
  return bytes;
}

PendingFiles::~PendingFiles() {
  for (const Pending& file : files_) {
    close(file.descriptor);
    if (!file.temporary.empty()) unlink(file.temporary.c_str());
  }
}

Status PendingFiles::add(const fs::path& path, std::span<const std::uint8_t> bytes) {
  const fs::path target = followed(path);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  struct stat info {};
  const bool exists = stat(target.c_str(), &info) == 0;
  if (exists && !S_ISREG(info.st_mode))
    return cannot_write(path, S_ISDIR(info.st_mode) ? "is a directory" : "is not a regular file");
  Pending file{path, target, {}, open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666)};
  if (file.descriptor < 0)  // a file system without nameless files
    file.temporary = with_new_name(folder, [&](const char* name) {
      file.descriptor = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      return file.descriptor >= 0;
    });
  if (file.descriptor < 0) return cannot_write(path, std::strerror(errno));
  files_.push_back(file);
  const bool written =
      write_all(file.descriptor, bytes) && (!exists || fchmod(file.descriptor, info.st_mode & 0777) == 0);
  if (!written) return cannot_write(path, std::strerror(errno));
  return Done{};
}

Status PendingFiles::add(const fs::path& path, std::string_view text) { return add(path, bytes_of(text)); }

/// Puts the file in its place. A name in the way cannot be linked over, only renamed over.
bool PendingFiles::place(Pending& file) {
  if (file.temporary.empty() && link_as(file.descriptor, file.target.c_str())) return true;
  if (file.temporary.empty())
    file.temporary = with_new_name(file.target.parent_path(),
                                   [&](const char* name) { return link_as(file.descriptor, name); });
  if (file.temporary.empty() || std::rename(file.temporary.c_str(), file.target.c_str()) != 0) return false;
  file.temporary.clear();
  return true;
}

Status PendingFiles::commit() {
  while (!files_.empty()) {
    Pending& file = files_.front();
    if (!place(file)) return cannot_write(file.path, std::strerror(errno));
    close(file.descriptor);
    files_.erase(files_.begin());
  }
  return Done{};
}

Status write_file(const fs::path& path, std::span<const std::uint8_t> bytes) {
  PendingFiles file;
  if (const Status status = file.add(path, bytes); !status) return status.error();
  return file.commit();
}

Status write_file(const fs::path& path, std::string_view text) { return write_file(path, bytes_of(text)); }

std::optional<fs::path> file_below(const fs::path& folder, const fs::path& relative) {
  if (relative.empty() || relative.is_absolute() || relative.native().find('\0') != std::string::npos)
    return std::nullopt;
  for (const auto& part : relative)
    if (part == "..") return std::nullopt;
  const fs::path path = folder / relative;
  std::error_code error;
  const fs::path real_folder = fs::canonical(folder.empty() ? "." : folder, error);
  if (error) return path;  // nothing is there to be read
  const fs::path real = fs::weakly_canonical(path, error);
  if (error) return path;
  const auto [end, rest] = std::mismatch(real_folder.begin(), real_folder.end(), real.begin(), real.end());
  return end == real_folder.end() ? std::optional(path) : std::nullopt;
}

Result<fs::path> find_asset(const fs::path& relative) {
  std::vector<fs::path> folders;
  if (const char* folder = std::getenv("UKEMI_ASSETS")) folders.emplace_back(folder);
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    folders.push_back(program.parent_path().parent_path() / "share" / "ukemi");
    folders.push_back(program.parent_path() / "ukemi-assets");
  }
  for (const fs::path& folder : folders)
    if (fs::exists(folder / relative, error)) return folder / relative;
  return input_error(relative, "the program's own file is missing",
                     "set UKEMI_ASSETS to the project's assets folder, or install again");
}

}  // namespace ukemi
