// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "mesh/reserved_memory.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <new>

#include "space/system.hpp"

namespace pgdr {
namespace system = detail::system;
namespace {

constexpr std::size_t huge_page = std::size_t{1} << 21;
constexpr std::size_t first_step = std::size_t{1} << 16;
constexpr std::size_t bytes_an_element = 200;  // what a mesh reserves for each of its ids, or a little more

constexpr std::size_t rounded_up(std::size_t bytes, std::size_t unit) { return (bytes + unit - 1) / unit * unit; }

}  // namespace

void touch_pages(std::span<std::byte> fresh) {
  constexpr std::size_t smallest_page = 4096;
  for (std::size_t i = 0; i < fresh.size(); i += smallest_page) static_cast<volatile std::byte&>(fresh[i]) = std::byte{0};
}

// Pages without access count against nothing but the limit on addresses.
ReservedMemory::ReservedMemory(std::size_t bytes) : reserved_(rounded_up(bytes, huge_page)) {
  mapped_ = system::reserve_addresses(reserved_ + huge_page);
  if (mapped_ == nullptr) throw std::bad_alloc();
  const auto address = reinterpret_cast<std::uintptr_t>(mapped_);
  base_ = static_cast<std::byte*>(mapped_) + (rounded_up(address, huge_page) - address);
}

ReservedMemory::~ReservedMemory() { system::release_addresses(mapped_, reserved_ + huge_page); }

// Steps grow with the array, so that there are few; from the first huge page on they are huge pages.
void ReservedMemory::grow(std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  const std::size_t usable = usable_.load(std::memory_order_relaxed);
  if (bytes <= usable) return;
  std::size_t wanted = std::max({bytes, usable + usable / 8, first_step});
  wanted = std::min(rounded_up(wanted, wanted < huge_page ? first_step : huge_page), reserved_);
  if (!system::provide_memory(base_ + usable, wanted - usable)) throw std::bad_alloc();
  if (wanted > huge_page) system::ask_for_huge_pages(base_ + usable, wanted - usable);
  usable_.store(wanted, std::memory_order_release);
}

std::vector<std::span<std::byte>> ReservedMemory::fresh_pages(std::size_t first, std::size_t bytes) {
  std::vector<std::span<std::byte>> pages;
  first = rounded_up(std::max(first, returned_), huge_page);
  const std::size_t last = std::min(bytes, reserved_) / huge_page * huge_page;
  if (first >= last) return pages;
  grow_to(last);
  returned_ = last;
  for (; first < last; first += huge_page) pages.emplace_back(base_ + first, huge_page);
  return pages;
}

void ReservedMemory::discard(std::size_t first, std::size_t last) {
  first = rounded_up(first, huge_page);
  last = std::min(last, usable_.load(std::memory_order_relaxed)) / huge_page * huge_page;
  if (first < last) system::discard_memory(base_ + first, last - first);
}

// Half of what there is, so that others have some. The limit counts, and what the kernel (or what stands between) gives.
std::size_t ReservedMemory::affordable_elements(std::size_t elements) {
  if (const double limit = system::limit_on_addresses(); std::isfinite(limit))
    elements = std::min(elements, static_cast<std::size_t>(limit) / 2 / bytes_an_element);
  for (bool first = true; elements > (std::size_t{1} << 16); elements /= 2, first = false) {
    const std::size_t bytes = elements * bytes_an_element;
    void* const p = system::reserve_addresses(bytes);
    if (p == nullptr) continue;
    system::release_addresses(p, bytes);
    return first ? elements : elements / 2;
  }
  return elements;
}

}  // namespace pgdr
