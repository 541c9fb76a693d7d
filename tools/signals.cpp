// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "signals.hpp"

#ifdef _WIN32
#include <windows.h>
#else
#include <pthread.h>
#endif

#include <chrono>

namespace pgdr::tool {

#ifdef _WIN32
// Windows calls its handler in a thread of its own, where locks may be taken. What the handler does not take ends the process.
static StopOnSignal* listener = nullptr;

static BOOL WINAPI on_event(DWORD event) {
  if ((event != CTRL_C_EVENT && event != CTRL_BREAK_EVENT) || listener == nullptr || listener->token().stop_requested())
    return FALSE;
  return listener->interrupt() ? TRUE : FALSE;
}

bool StopOnSignal::interrupt() { return heard_ && stop_.request_stop(); }

StopOnSignal::StopOnSignal() {
  listener = this;
  SetConsoleCtrlHandler(on_event, TRUE);
}

StopOnSignal::~StopOnSignal() {
  SetConsoleCtrlHandler(on_event, FALSE);
  listener = nullptr;
}
#else
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
#endif

}  // namespace pgdr::tool
