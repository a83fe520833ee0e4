#include "client/cli/interruption.h"

#include <csignal>

namespace papilio::client {
namespace {

volatile std::sig_atomic_t asked = 0;

extern "C" void ask(int signal) {
  asked = 1;
  (void)std::signal(signal, SIG_DFL);
}

constexpr int handled[] = {SIGINT, SIGTERM};

}  // namespace

Interruption::Interruption() {
  asked = 0;
  for (const int signal : handled) (void)std::signal(signal, ask);
}

Interruption::~Interruption() {
  for (const int signal : handled) (void)std::signal(signal, SIG_DFL);
}

bool Interruption::is_asked() { return asked != 0; }

}  // namespace papilio::client
