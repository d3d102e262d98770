#include "base/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace ukemi {
namespace fs = std::filesystem;
namespace {

Error input_error(const fs::path& path, std::string what, std::string fix) {
  return {ErrorKind::input, path.string(), 0, 0, "", std::move(what), std::move(fix)};
}

Error output_error(const fs::path& path, const std::string& what) {
  return {ErrorKind::output,
          path.string(),
          0,
          0,
          "",
          "cannot write: " + what,
          "choose a folder that exists, has space and that you may write to"};
}

/// A file without a name, where the file system has such: it vanishes with the process that writes it. Else
/// one beside the target, removed unless it is finished.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target) : path_(target.string() + ".XXXXXX") {
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    fd_ = open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);
    if (fd_ >= 0) return;
    fd_ = mkostemp(path_.data(), O_CLOEXEC);
    named_ = fd_ >= 0;
  }
  ~TemporaryFile() {
    if (fd_ >= 0) close(fd_);
    if (named_) unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  bool ok() const { return fd_ >= 0; }
  bool write_all(std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
      const ssize_t n = ::write(fd_, bytes.data(), bytes.size());
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return false;
      bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
    return true;
  }
  bool finish_as(const fs::path& target) {
    const mode_t mask = umask(0);
    umask(mask);
    if (fchmod(fd_, 0666 & ~mask) != 0) return false;
    if (!named_ && link_as(target.string())) return true;
    if (!named_ && !give_name()) return false;
    const int fd = fd_;
    fd_ = -1;
    if (close(fd) != 0 || std::rename(path_.c_str(), target.c_str()) != 0) return false;
    named_ = false;
    return true;
  }

 private:
  bool link_as(const std::string& path) const {
    const std::string self = "/proc/self/fd/" + std::to_string(fd_);
    return linkat(AT_FDCWD, self.c_str(), AT_FDCWD, path.c_str(), AT_SYMLINK_FOLLOW) == 0;
  }
  /// A link cannot replace a file, so that it needs a name of its own to be renamed from.
  bool give_name() {
    constexpr int kTries = 100;
    const std::string stem = path_.substr(0, path_.size() - 6) + std::to_string(getpid()) + ".";
    for (int i = 0; i < kTries && !named_; ++i) {
      path_ = stem + std::to_string(i);
      named_ = link_as(path_);
      if (!named_ && errno != EEXIST) return false;
    }
    return named_;
  }

  std::string path_;
  int fd_ = -1;
  bool named_ = false;
};

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

Status write_file(const fs::path& path, std::span<const std::uint8_t> bytes) {
  struct stat info {};
  if (stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode))
    return output_error(path, S_ISDIR(info.st_mode) ? "is a directory" : "is not a regular file");
  TemporaryFile file(path);
  if (!file.ok() || !file.write_all(bytes) || !file.finish_as(path))
    return output_error(path, std::strerror(errno));
  return Done{};
}

Status write_file(const fs::path& path, std::string_view text) {
  return write_file(path, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

Result<fs::path> find_asset(const fs::path& relative) {
  std::vector<fs::path> folders;
  if (const char* folder = std::getenv("UKEMI_ASSETS")) folders.emplace_back(folder);
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) folders.push_back(program.parent_path().parent_path() / "share" / "ukemi");
  folders.emplace_back(UKEMI_SOURCE_ASSETS);
  for (const fs::path& folder : folders)
    if (fs::exists(folder / relative, error)) return folder / relative;
  return Error{ErrorKind::input,
               relative.string(),
               0,
               0,
               "",
               "the program's own file is missing",
               "set UKEMI_ASSETS to the project's assets folder, or install again"};
}

}  // namespace ukemi
