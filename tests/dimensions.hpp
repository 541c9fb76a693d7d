// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests of both dimensions: TYPED_TEST_SUITE(Suite, test::Dimensions), then TypeParam::value.
#pragma once

#include <gtest/gtest.h>

#include <type_traits>

namespace pgdr::test {

using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;

}  // namespace pgdr::test
