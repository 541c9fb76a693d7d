// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What tools/json.hpp writes, read by a JSON library that is not ours.
#include "json.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

namespace {

using pgdr::tool::Json;
using pgdr::tool::JsonObject;

nlohmann::json read(const Json& value) { return nlohmann::json::parse(value.text()); }

TEST(Json, NumbersReadBackToTheSameBits) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 10000; ++i) {
    const auto value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    const auto back = read(value);
    ASSERT_TRUE(back.is_number_float()) << Json(value).text();
    ASSERT_EQ(std::bit_cast<std::uint64_t>(back.get<double>()), std::bit_cast<std::uint64_t>(value));
  }
  EXPECT_EQ(Json(2.0).text(), "2.0");
  EXPECT_EQ(Json(std::numeric_limits<std::uint64_t>::max()).text(), "18446744073709551615");
  EXPECT_EQ(Json(-3).text(), "-3");
  EXPECT_TRUE(read(std::numeric_limits<double>::infinity()).is_null());
  EXPECT_TRUE(read(std::nan("")).is_null());
}

TEST(Json, Strings) {
  for (const std::string s : {"", "plain", "\"\\/", "line\nline\t\x01", "\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80", "\x7f"})
    EXPECT_EQ(read(s).get<std::string>(), s);
  EXPECT_EQ(read(std::string(1, '\0')).get<std::string>(), std::string(1, '\0'));
}

TEST(Json, BytesThatAreNotUtf8BecomeReplacementCharacters) {
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    std::string s(random() % 6, '\0');
    for (char& c : s) c = static_cast<char>(random() % 2 ? random() : 0xe0 + random() % 32);
    const std::string expected = nlohmann::json(s).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    const std::string back = read(s).get<std::string>();  // throws if it is not UTF-8
    if (expected.find("\xef\xbf\xbd") == std::string::npos) {
      ASSERT_EQ(back, s);
    }
  }
  EXPECT_EQ(read("a\xff z").get<std::string>(), "a\xef\xbf\xbd z");
}

TEST(Json, ObjectsKeepTheirOrderAndReplace) {
  JsonObject o{{"b", 1}, {"a", std::vector<double>{1, 2.5}}, {"c", JsonObject{{"x", true}, {"y", nullptr}}}};
  o.set("b", "two");
  EXPECT_EQ(Json(o).text(), R"({"b": "two", "a": [1.0, 2.5], "c": {"x": true, "y": null}})");
  EXPECT_EQ(nlohmann::json::parse(o.pretty()), read(o));
  EXPECT_TRUE(o.contains("a"));
  EXPECT_FALSE(o.contains("x"));
  EXPECT_EQ(Json(JsonObject()).text(), "{}");
  EXPECT_EQ(Json(std::vector<int>()).text(), "[]");
}

}  // namespace
