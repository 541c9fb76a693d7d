// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Bytes as a message of one rank to another (rank_messages.hpp): the first byte says which kind and dimension. It is read, or
// refused by a typed error.
#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>

#include "expect.hpp"
#include "pgdr/error.hpp"
#include "rank_messages.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    pgdr::test::read_any_message({reinterpret_cast<const std::byte*>(data), size});
  } catch (const pgdr::Error&) {  // ResourceError internal, or the error that the message has
  } catch (const std::exception& e) {
    FUZZ_EXPECT(false, e.what());
  }
  return 0;
}
