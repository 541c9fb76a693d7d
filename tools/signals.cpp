// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "signals.hpp"

#include <pthread.h>

#include <chrono>

namespace pgdr::tool {

StopOnSignal::StopOnSignal() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals_, &before_);
  try {
    watcher_ = std::thread([this] {
      int signal = 0;
      if (sigwait(&signals_, &signal) != 0 || over_) return;
      if (!heard_) return end_by(signal);
      stop_.request_stop();
      // The same request may come twice: timeout(1) signals its child, and then the group of both.
      const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(1);
      do {
        if (sigwait(&signals_, &signal) != 0 || over_) return;
      } while (heard_ && std::chrono::steady_clock::now() < patience);
      end_by(signal);
    });
  } catch (...) {
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    throw;
  }
}

void StopOnSignal::end_by(int signal) const {
  std::signal(signal, SIG_DFL);
  pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr);
  std::raise(signal);
}

StopOnSignal::~StopOnSignal() {
  over_ = true;
  pthread_kill(watcher_.native_handle(), SIGTERM);  // wakes it; blocked everywhere else
  watcher_.join();
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

}  // namespace pgdr::tool
