// SPDX-License-Identifier: Apache-2.0
#include "node/server/name_lookup.hpp"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <thread>

namespace takt::node {

NameLookup::NameLookup(std::string name) : shared_(std::make_shared<Shared>()) {
  shared_->name = std::move(name);
  std::thread([shared = shared_] {
    try {
      look_up(*shared);
    } catch (...) {  // no memory: then there is no address, and nobody waits
      shared->addresses.clear();
    }
    shared->is_done.store(true, std::memory_order_release);
    shared->wake.signal();
  }).detach();
}

void NameLookup::look_up(Shared& shared) {
  shared.problem = "no address of " + shared.name + ": no memory";
  addrinfo hints = {};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(shared.name.c_str(), nullptr, &hints, &found);
  const int reason = errno;
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(found, [](addrinfo* each) {
    if (each != nullptr) ::freeaddrinfo(each);
  });
  for (const addrinfo* each = found; each != nullptr && shared.addresses.size() < most_addresses;
       each = each->ai_next) {
    std::array<char, INET_ADDRSTRLEN> text{};
    ::inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(each->ai_addr)->sin_addr, text.data(), text.size());
    if (std::find(shared.addresses.begin(), shared.addresses.end(), text.data()) == shared.addresses.end())
      shared.addresses.emplace_back(text.data());
  }
  shared.problem = !shared.addresses.empty() ? ""
                                             : "no address of " + shared.name + ": " +
                                                   (error == EAI_SYSTEM ? std::strerror(reason)
                                                    : error != 0        ? ::gai_strerror(error)
                                                                        : "no IPv4 address");
}

}  // namespace takt::node
