// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What all ranks do together, by ranks that are threads: messages in any order, errors of one rank on all, damaged messages.
#include "transport/collectives.hpp"

#include <gtest/gtest.h>

#include <array>
#include <mutex>
#include <numeric>
#include <string>
#include <typeinfo>

#include "local_ranks.hpp"
#include "transport/message.hpp"
#include "transport/shared_error.hpp"

namespace pgdr::test_transport_collectives {

using detail::Collectives;
using detail::MessageReader;
using detail::MessageWriter;
using test::errors_of_local_ranks;
using test::run_on_local_ranks;

constexpr std::array sizes{1, 2, 3, 4, 5, 8, 13};
constexpr std::uint64_t seeds = 20;

/// `f` for all of `sizes`, with messages in several orders.
template <class F>
void each_network(F f) {
  for (const int ranks : sizes)
    for (std::uint64_t seed = 0; seed < seeds; ++seed) run_on_local_ranks(ranks, seed, f);
}

/// A message of `rank` for `to`, of a length that differs; some are empty.
Bytes message_of(int rank, int to = 0) {
  return Bytes(static_cast<std::size_t>((rank * 7 + to * 3) % 11), static_cast<std::byte>(16 * rank + to));
}

std::vector<Bytes> messages_of_all(int ranks, int to) {
  std::vector<Bytes> all;
  for (int q = 0; q < ranks; ++q) all.push_back(message_of(q, to));
  return all;
}

TEST(Collectives, EachRankGetsWhatAllGive) {
  each_network([](Transport& transport) {
    Collectives ranks(transport);
    EXPECT_EQ(ranks.all_gather(message_of(ranks.rank())), messages_of_all(ranks.size(), 0));
    EXPECT_EQ(ranks.all_gather({}), std::vector<Bytes>(static_cast<std::size_t>(ranks.size())));
  });
}

TEST(Collectives, EachRankGetsWhatIsForIt) {
  each_network([](Transport& transport) {
    Collectives ranks(transport);
    std::vector<Bytes> own;
    for (int to = 0; to < ranks.size(); ++to) own.push_back(message_of(ranks.rank(), to));
    EXPECT_EQ(ranks.exchange(own), messages_of_all(ranks.size(), ranks.rank()));
  });
}

TEST(Collectives, NeighboursExchange) {
  each_network([](Transport& transport) {
    Collectives ranks(transport);
    std::vector<int> neighbours;  // in a line; the higher first
    if (ranks.rank() + 1 < ranks.size()) neighbours.push_back(ranks.rank() + 1);
    if (ranks.rank() > 0) neighbours.push_back(ranks.rank() - 1);
    for (int phase = 0; phase < 3; ++phase) {
      std::vector<Bytes> own, expected;
      for (const int q : neighbours) {
        own.push_back(message_of(ranks.rank(), q));
        expected.push_back(message_of(q, ranks.rank()));
      }
      EXPECT_EQ(ranks.exchange_with(neighbours, own), expected);
    }
    EXPECT_EQ(ranks.traffic().messages, 3 * neighbours.size());
  });
}

TEST(Collectives, AnyRankIsTheRoot) {
  each_network([](Transport& transport) {
    Collectives ranks(transport);
    for (int root = 0; root < ranks.size(); ++root) {
      EXPECT_EQ(ranks.broadcast(root, message_of(ranks.rank(), root)), message_of(root, root));
      const std::vector<Bytes> all = ranks.gather(root, message_of(ranks.rank(), root));
      EXPECT_EQ(all, root == ranks.rank() ? messages_of_all(ranks.size(), root) : std::vector<Bytes>());
      EXPECT_EQ(ranks.scatter(root, messages_of_all(ranks.size(), root)), message_of(ranks.rank(), root));
    }
  });
}

TEST(Collectives, SumsAndExtremes) {
  each_network([](Transport& transport) {
    Collectives ranks(transport);
    using Numbers = std::vector<std::uint64_t>;
    const auto n = static_cast<std::uint64_t>(ranks.size()), r = static_cast<std::uint64_t>(ranks.rank());
    const Numbers own{r, n - r, 7};
    EXPECT_EQ(ranks.sum(own), (Numbers{n * (n - 1) / 2, n * (n + 1) / 2, 7 * n}));
    EXPECT_EQ(ranks.max(own), (Numbers{n - 1, n, 7}));
    EXPECT_EQ(ranks.min(own), (Numbers{0, 1, 7}));
    EXPECT_EQ(ranks.exclusive_sum(r + 1), r * (r + 1) / 2);
    EXPECT_EQ(ranks.sum(std::span<const std::uint64_t>()), Numbers());
    const std::vector<double> reals{0.5 * static_cast<double>(r)};
    EXPECT_EQ(ranks.sum(reals).front(), 0.25 * static_cast<double>(n * (n - 1)));
    EXPECT_EQ(ranks.max(reals).front(), 0.5 * static_cast<double>(n - 1));
    EXPECT_EQ(ranks.min(reals).front(), 0);
  });
}

TEST(Collectives, EachRankGetsTheNumbersOfAll) {
  each_network([](Transport& transport) {
    Collectives ranks(transport);
    const auto row = [](int rank) {
      return std::vector<std::uint64_t>(static_cast<std::size_t>(rank % 3), 7u + static_cast<unsigned>(rank));
    };
    std::vector<std::vector<std::uint64_t>> expected;
    for (int q = 0; q < ranks.size(); ++q) expected.push_back(row(q));
    EXPECT_EQ(ranks.all_gather(row(ranks.rank()), nullptr), expected);
  });
}

/// The rounding of a sum depends on its order: all ranks must see one.
TEST(Collectives, SumsOfDoublesAreTheSameOnAllRanks) {
  constexpr int many = 13;
  std::array<double, many> sums{};
  run_on_local_ranks(many, 1, [&](Transport& transport) {
    Collectives ranks(transport);
    const double own = 1.0 / (3 + transport.rank());
    sums[static_cast<std::size_t>(transport.rank())] = ranks.sum(std::span(&own, 1)).front();
  });
  for (const double sum : sums) EXPECT_EQ(sum, sums[0]);
}

TEST(Collectives, SeveralConversationsDoNotMix) {
  each_network([](Transport& transport) {
    Collectives first(transport);
    EXPECT_EQ(first.sum(1), static_cast<std::uint64_t>(first.size()));
    Collectives second(transport);
    EXPECT_EQ(second.broadcast(0, message_of(second.rank())), message_of(0));
    EXPECT_EQ(first.broadcast(0, message_of(first.rank())), message_of(0));
  });
}

// Errors.

/// Type and words of what was thrown.
std::string words(const std::exception_ptr& error) {
  if (!error) return "nothing";
  try {
    std::rethrow_exception(error);
  } catch (const std::exception& e) {
    return std::string(typeid(e).name()) + ' ' + e.what();
  }
}

template <class E>
std::string words(const E& error) {
  return words(std::make_exception_ptr(error));
}

const Diagnostic named{Errc::syntax, "no number", "a.poly", 7, {1, -2}, {{0.5, 1, 2}}};

template <class E>
void expect_on_all(const E& error) {
  for (const int ranks : sizes)
    for (const std::exception_ptr& found : errors_of_local_ranks(ranks, 1, [&](Transport& transport) {
           Collectives all(transport);
           all.together([&] {
             if (transport.rank() == transport.size() / 2) throw error;
           });
         }))
      EXPECT_EQ(words(found), words(error));
}

TEST(Together, AllRanksThrowTheSameTypedError) {
  expect_on_all(UsageError(named));
  expect_on_all(InputError(named));
  expect_on_all(DiagnosedError(named));
  expect_on_all(FileError(named));
  expect_on_all(CancelledError(named));
  expect_on_all(ResourceError(named));
  expect_on_all(Error(named));
}

TEST(Together, AllDiagnosticsTravel) {
  const std::vector<std::exception_ptr> errors = errors_of_local_ranks(2, 1, [](Transport& transport) {
    Collectives all(transport);
    all.together([&] {
      if (transport.rank() == 1) throw DiagnosedError(named, {named, {Errc::truncated, "the end", {}, 0, {}, {}}});
    });
  });
  for (const std::exception_ptr& error : errors) {
    try {
      std::rethrow_exception(error);
    } catch (const DiagnosedError& e) {
      ASSERT_EQ(e.diagnostics().size(), 2u);
      EXPECT_EQ(e.diagnostics()[0].ids, named.ids);
      EXPECT_EQ(e.diagnostics()[1].message, "the end");
    }
  }
}

TEST(Together, AllOfADiagnosticTravels) {
  const std::vector<std::exception_ptr> errors = errors_of_local_ranks(2, 1, [](Transport& transport) {
    Collectives ranks(transport);
    ranks.together([&] {
      if (transport.rank() == 0) throw InputError(named);
    });
  });
  try {
    std::rethrow_exception(errors[1]);
  } catch (const InputError& e) {
    EXPECT_EQ(e.code(), named.code);
    EXPECT_EQ(e.diagnostic().message, named.message);
    EXPECT_EQ(e.diagnostic().file, named.file);
    EXPECT_EQ(e.diagnostic().line, named.line);
    EXPECT_EQ(e.diagnostic().ids, named.ids);
    EXPECT_EQ(e.diagnostic().points, named.points);
  }
}

TEST(Together, WhatHasNoTypeHereIsThrownAsItIsByItsOwnRank) {
  const std::vector<std::exception_ptr> errors = errors_of_local_ranks(3, 1, [](Transport& transport) {
    Collectives ranks(transport);
    ranks.together([&] {
      if (transport.rank() == 1) throw std::runtime_error("the caller's");
    });
  });
  const std::string elsewhere = words(RankFailure({.code = Errc::rank_failed, .message = "rank 1: the caller's"}));
  EXPECT_EQ(words(errors[0]), elsewhere);
  EXPECT_EQ(words(errors[1]), words(std::runtime_error("the caller's")));
  EXPECT_EQ(words(errors[2]), elsewhere);
}

TEST(Together, NoMemoryOnOneRankIsAResourceErrorOnTheOthers) {
  const std::vector<std::exception_ptr> errors = errors_of_local_ranks(2, 1, [](Transport& transport) {
    Collectives ranks(transport);
    ranks.together([&] {
      if (transport.rank() == 1) throw std::bad_alloc();
    });
  });
  EXPECT_EQ(words(errors[0]), words(ResourceError({.code = Errc::out_of_memory, .message = "rank 1: out of memory"})));
  EXPECT_EQ(words(errors[1]), words(std::bad_alloc()));
}

/// Whoever is first: the lowest rank's error wins.
TEST(Together, TheErrorOfTheLowestRankWins) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (const std::exception_ptr& error : errors_of_local_ranks(5, seed, [](Transport& transport) {
           Collectives ranks(transport);
           ranks.together([&] {
             if (transport.rank() >= 2) throw UsageError({.code = Errc::bad_option, .message = std::to_string(transport.rank())});
           });
         }))
      EXPECT_EQ(words(error), words(UsageError({.code = Errc::bad_option, .message = "2"})));
}

TEST(Together, AnErrorBesideNumbersIsThrownByAll) {
  for (const int size : sizes)
    for (const std::exception_ptr& found : errors_of_local_ranks(size, 1, [](Transport& transport) {
           Collectives ranks(transport);
           EXPECT_EQ(ranks.all_gather(std::array<std::uint64_t, 1>{3}, nullptr).size(), static_cast<std::size_t>(ranks.size()));
           const auto error = Collectives::caught([&] {
             if (transport.rank() == transport.size() / 2) throw InputError(named);
           });
           ranks.all_gather(std::array<std::uint64_t, 1>{3}, error);
         }))
      EXPECT_EQ(words(found), words(InputError(named)));
}

TEST(Together, ReturnsWhatTheFunctionDoesAndGoesOn) {
  each_network([](Transport& transport) {
    Collectives ranks(transport);
    EXPECT_EQ(ranks.together([&] { return std::to_string(transport.rank()); }), std::to_string(transport.rank()));
    EXPECT_EQ(ranks.sum(1), static_cast<std::uint64_t>(transport.size()));
  });
}

/// A rank that ends without a word: those who need it end, too, and say which it was.
TEST(LocalRanks, ARankThatIsGoneIsNamed) {
  const std::vector<std::exception_ptr> errors = errors_of_local_ranks(4, 1, [](Transport& transport) {
    if (transport.rank() == 2) throw std::runtime_error("gone");
    Collectives(transport).sum(1);
  });
  EXPECT_EQ(words(errors[2]), words(std::runtime_error("gone")));
  for (const std::size_t rank : {0, 1, 3}) EXPECT_TRUE(test::is_rank_failure(errors[rank])) << words(errors[rank]);
  EXPECT_THROW(run_on_local_ranks(4, 1,
                                  [](Transport& transport) {
                                    if (transport.rank() == 2) throw std::runtime_error("gone");
                                    Collectives(transport).sum(1);
                                  }),
               std::runtime_error);
}

TEST(LocalRanks, RanksThatAllWaitAreAnError) {
  EXPECT_THROW(run_on_local_ranks(3, 1, [](Transport& transport) { transport.receive((transport.rank() + 1) % 3, 0); }),
               RankFailure);
}

TEST(LocalRanks, ATagIsUsedOnce) {
  EXPECT_THROW(run_on_local_ranks(2, 1,
                                  [](Transport& transport) {
                                    transport.send(0, 5, {});
                                    transport.send(0, 5, {});
                                  }),
               std::logic_error);
}

// Messages.

struct Mixed {
  std::uint64_t a;
  double b;
  friend bool operator==(const Mixed&, const Mixed&) = default;
};

Bytes some_message() {
  MessageWriter writer;
  writer.put(std::uint16_t{7});
  writer.put(std::vector<Mixed>{{1, 0.5}, {2, -1.5}});
  writer.put(std::string("words"));
  writer.put(std::span<const std::uint32_t>());
  return writer.take();
}

/// Reads all of it. @returns is it as it was written?
bool read_message(const Bytes& bytes) {
  MessageReader reader(bytes);
  bool same = reader.get<std::uint16_t>() == 7;
  same = reader.get_all<Mixed>() == std::vector<Mixed>{{1, 0.5}, {2, -1.5}} && same;
  same = reader.get_text() == "words" && same;
  same = reader.get_all<std::uint32_t>().empty() && same;
  reader.require_end();
  return same;
}

TEST(Messages, AreReadAsWritten) { EXPECT_TRUE(read_message(some_message())); }

TEST(Messages, CutShortOrTooLongIsAnError) {
  const Bytes whole = some_message();
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_THROW(read_message(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length))), ResourceError)
        << length;
  Bytes longer = whole;
  longer.push_back(std::byte{0});
  EXPECT_THROW(read_message(longer), ResourceError);
}

/// Either other values or an error: no crash, and no memory for what cannot be there.
TEST(Messages, FlippedBitsDoNoHarm) {
  const Bytes whole = some_message();
  std::size_t refused = 0;
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    Bytes flipped = whole;
    flipped[bit / 8] ^= std::byte{1} << (bit % 8);
    try {
      EXPECT_FALSE(read_message(flipped)) << bit;
    } catch (const ResourceError& e) {
      EXPECT_EQ(e.code(), Errc::internal);
      ++refused;
    }
  }
  EXPECT_GE(refused, 3 * 64u - 8);  // three lengths of 64 bits; few of their bits make another that fits
}

TEST(Messages, DamagedErrorsAreErrors) {
  MessageWriter writer;
  detail::put_error(writer, std::make_exception_ptr(InputError(named)), 1);
  const Bytes whole = writer.take();
  const auto read = [](const Bytes& bytes) {
    MessageReader reader(bytes);
    detail::throw_error(reader);
  };
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_THROW(read(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length))), ResourceError);
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    Bytes flipped = whole;
    flipped[bit / 8] ^= std::byte{1} << (bit % 8);
    EXPECT_THROW(read(flipped), Error);  // another one, or that it is none
  }
}

}  // namespace pgdr::test_transport_collectives
