// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/output_files.hpp"

#include <cerrno>
#include <cstdio>
#include <exception>
#include <new>
#include <ostream>
#include <streambuf>

#include "paths/file_output.hpp"
#include "paths/write_target.hpp"
#include "space/system.hpp"

namespace pgdr {
namespace {

/// A stream into a file. Streams swallow exceptions: this keeps the first.
class OutputBuffer final : public std::streambuf {
 public:
  explicit OutputBuffer(detail::FileOutput& out) : out_(out) {}
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  bool put(const char* bytes, std::size_t n) {
    if (failure_) return false;
    try {
      out_.put({bytes, n});
      return true;
    } catch (...) {
      failure_ = std::current_exception();
      return false;
    }
  }
  int_type overflow(int_type c) override {
    const char byte = traits_type::to_char_type(c);
    const bool is_none = traits_type::eq_int_type(c, traits_type::eof());
    return is_none || put(&byte, 1) ? traits_type::not_eof(c) : traits_type::eof();
  }
  std::streamsize xsputn(const char* bytes, std::streamsize n) override {
    return put(bytes, static_cast<std::size_t>(n)) ? n : 0;
  }

  detail::FileOutput& out_;
  std::exception_ptr failure_;
};

}  // namespace

void write_file(const std::filesystem::path& file, const std::function<void(std::ostream&)>& write) {
  detail::FileOutput out(file);
  OutputBuffer buffer(out);
  std::ostream stream(&buffer);
  write(stream);
  buffer.rethrow();
  if (!stream) detail::cannot_write(file.string(), "what makes it failed");
  out.commit();
}

void require_writable(const std::filesystem::path& file) {
  const detail::WriteTarget target = detail::target_of(file.string());
  if (target.is_stream()) return;
  if (!detail::system::is_there(detail::folder_of(target.name))) detail::cannot_write(file.string(), "there is no such folder");
  const detail::FileOutput begun(file);  // and removed: permissions say nothing of folders of the system
}

std::filesystem::path place_of_output(const std::filesystem::path& file) { return detail::target_of(file.string()).name; }

bool is_written_to(const std::filesystem::path& file) { return detail::target_of(file.string()).is_stream(); }

void remove_output(const std::string& file) noexcept {
  try {
    const detail::WriteTarget target = detail::target_of(file);
    if (!target.is_stream()) std::remove(target.name.c_str());
  } catch (const std::bad_alloc&) {  // without memory no link is followed
    if (detail::system::is_regular_itself(file)) std::remove(file.c_str());
  } catch (...) {  // then there is nothing that this library has written
  }
}

}  // namespace pgdr
