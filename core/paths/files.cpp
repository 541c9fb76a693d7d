// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cerrno>
#include <memory>
#include <random>
#include <system_error>
#include <utility>
#include <vector>

#include "paths/file_input.hpp"
#include "paths/file_output.hpp"
#include "paths/write_target.hpp"
#include "pgdr/error.hpp"
#include "space/bulk.hpp"
#include "space/system.hpp"

namespace pgdr::detail {
namespace fs = std::filesystem;
namespace {

std::string reason(int error_number) { return std::generic_category().message(error_number); }

[[noreturn]] void cannot_open(const fs::path& file, const std::string& why) {
  throw FileError(Diagnostic{Errc::cannot_open, "cannot be read: " + why, file.string(), 0, {}, {}});
}

void publish(const PendingFile& file) {
  if (!system::replace_file(file.temporary, file.target)) cannot_write(file.target, errno);
}

std::string random_suffix() {
  std::random_device device;
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyz234567";
  std::string suffix;
  for (int i = 0; i < 12; ++i) suffix += letters[device() % letters.size()];
  return suffix;
}

/// A name in the same folder that nothing has yet. Strings all along: libstdc++'s path does not survive a failing
/// allocation.
std::string name_beside(const std::string& target) {
  const std::size_t folder = target.rfind('/') + 1;  // 0 if there is none
  std::string name = target.substr(0, folder).append(1, '.').append(target, folder, 200);
  return name.append(1, '.').append(random_suffix()).append(".tmp");
}

}  // namespace

std::string read_whole_file(const fs::path& file) {
  std::error_code ec;
  if (fs::is_directory(file, ec)) cannot_open(file, "it is a directory");
  std::FILE* const stream = std::fopen(names_stream(file.string()) ? "/dev/stdin" : file.string().c_str(), "rb");
  if (stream == nullptr) cannot_open(file, reason(errno));
  const auto close = [](std::FILE* f) { std::fclose(f); };
  const std::unique_ptr<std::FILE, decltype(close)> guard(stream, close);

  // Asked first, so that a large file is not copied while the string grows; but trusted for nothing, since pipes have
  // no size and files change.
  const std::uintmax_t size = fs::file_size(file, ec);
  std::string text;
  text.resize(ec ? 0 : static_cast<std::size_t>(size));
  std::size_t used = 0;
  for (;;) {
    if (used == text.size()) {
      char probe = 0;
      if (std::fread(&probe, 1, 1, stream) == 0) break;
      text.resize(text.size() + (std::size_t{1} << 16) + text.size() / 2);
      text[used++] = probe;
    }
    const std::size_t n = std::fread(text.data() + used, 1, text.size() - used, stream);
    used += n;
    if (n == 0) break;
  }
  if (std::ferror(stream) != 0) cannot_open(file, reason(errno));
  text.resize(used);
  return text;
}

FileOutput::FileOutput(const fs::path& target) : TextBuffer(std::size_t{1} << 20), target_(target_of(target.string())) {
  if (!target_.is_stream()) open_temporary();
}

void FileOutput::open_temporary() {
  constexpr int attempts = 100;
  for (int i = 0; i < attempts && stream_ == nullptr; ++i) {
    temporary_ = name_beside(target_.name);
    stream_ = system::create_new(temporary_);
    if (stream_ == nullptr && errno != EEXIST) break;
  }
  if (stream_ == nullptr) {
    const int error_number = errno;
    temporary_.clear();
    cannot_write(target_.name, error_number);
  }
  std::setvbuf(stream_, nullptr, _IONBF, 0);
  if (target_.kind == WriteTarget::Kind::old_file) system::take_over_mode(stream_, target_.name);
}

void FileOutput::open_stream() {
  stream_ = target_.kind == WriteTarget::Kind::descriptor ? system::open_descriptor(target_.descriptor)
                                                          : system::open_stream(target_.name);
  if (stream_ == nullptr) cannot_write(target_.name, errno);
  std::setvbuf(stream_, nullptr, _IONBF, 0);
}

FileOutput::~FileOutput() {
  if (stream_ != nullptr) std::fclose(stream_);
  if (!temporary_.empty()) std::remove(temporary_.c_str());
}

void FileOutput::make_room(std::size_t n) {
  flush();
  if (n > room()) TextBuffer::make_room(n);
}

/// Some blocks at a time, so that they take little memory whatever the file does.
void put_in_blocks(std::size_t count, const PutBlock& put_block, const std::function<void(std::string_view)>& sink) {
  constexpr std::size_t items = 1 << 13;
  const Bulk bulk(true);
  const std::size_t most_blocks = bulk.is_parallel() ? 32 : 1;
  std::vector<TextBuffer> texts(std::min(most_blocks, (count + items - 1) / items));
  for (std::size_t first = 0; first < count; first += most_blocks * items) {
    const std::size_t last = std::min(count, first + most_blocks * items);
    const std::size_t blocks = (last - first + items - 1) / items;
    bulk.parts(blocks, [&](std::size_t k) {
      texts[k].clear();
      put_block(texts[k], first + k * items, std::min(last, first + (k + 1) * items));
    });
    for (std::size_t k = 0; k < blocks; ++k) sink(texts[k].text());
  }
}

void FileOutput::put_blocks(std::size_t count, const PutBlock& put_block) {
  if (!Bulk(true).is_parallel()) return put_block(*this, 0, count);
  flush();
  put_in_blocks(count, put_block, [this](std::string_view bytes) { write(bytes); });
}

void FileOutput::flush() {
  write(text());
  clear();
}

void FileOutput::write(std::string_view bytes) {
  if (stream_ == nullptr) open_stream();
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_) != bytes.size()) cannot_write(target_.name, errno);
}

void FileOutput::close() {
  if (std::exchange(closed_, true)) return;
  flush();
  release();
  if (std::fclose(std::exchange(stream_, nullptr)) != 0) cannot_write(target_.name, errno);
}

void FileOutput::commit() {
  close();
  if (!is_stream()) publish(pending());
  set_published();
}

void publish_together(std::span<const PendingFile> files) {
  std::vector<std::string> aside(files.size());  // where the older files are meanwhile
  for (std::size_t i = 0; i < files.size(); ++i) aside[i] = name_beside(files[i].target);
  std::size_t kept = files.size(), published = 0;  // files[kept...] are aside, those before `published` are new
  try {
    for (; kept > 0; --kept) {
      const std::string& target = files[kept - 1].target;
      if (system::replace_file(target, aside[kept - 1])) continue;
      if (errno != ENOENT) cannot_write(target, errno);
      aside[kept - 1].clear();
    }
    for (; published < files.size(); ++published) publish(files[published]);
  } catch (...) {
    for (std::size_t i = 0; i < published; ++i) std::remove(files[i].target.c_str());
    for (std::size_t i = kept; i < files.size(); ++i)
      if (!aside[i].empty()) (void)system::replace_file(aside[i], files[i].target);  // nothing more can be done
    throw;
  }
  for (const std::string& name : aside)
    if (!name.empty()) std::remove(name.c_str());
}

void commit_together(std::span<const std::unique_ptr<FileOutput>> files) {
  std::vector<PendingFile> pending;
  for (const auto& f : files) {
    f->close();
    if (!f->is_stream()) pending.push_back(f->pending());
  }
  publish_together(pending);
  for (const auto& f : files) f->set_published();
}

}  // namespace pgdr::detail
