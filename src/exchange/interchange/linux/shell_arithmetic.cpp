// SPDX-License-Identifier: Apache-2.0
#include "interchange/linux/shell_arithmetic.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace takt::interchange::linux_tc {
namespace {

constexpr std::uint32_t deepest_sum = 32;

class Arithmetic {
 public:
  using Lookup = std::function<std::string(const std::string&)>;
  Arithmetic(std::string_view text, const Lookup& lookup) : text_(text), lookup_(lookup) {}
  std::optional<std::int64_t> value() {
    const auto sum = read_sum();
    skip();
    return at_ == text_.size() && sound_ ? std::optional(sum) : std::nullopt;
  }

 private:
  void skip() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n')) ++at_;
  }
  bool take(char c) {
    skip();
    if (at_ == text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  std::int64_t combined(char sign, std::int64_t a, std::int64_t b) {
    std::int64_t out = 0;
    if (sign == '+')
      sound_ = sound_ && !__builtin_add_overflow(a, b, &out);
    else if (sign == '-')
      sound_ = sound_ && !__builtin_sub_overflow(a, b, &out);
    else if (sign == '*')
      sound_ = sound_ && !__builtin_mul_overflow(a, b, &out);
    else if (b == 0 || b == -1)
      sound_ = false;
    else
      out = sign == '/' ? a / b : a % b;
    return out;
  }
  std::int64_t read_sum() {
    std::int64_t sum = read_product();
    while (true) {
      if (take('+'))
        sum = combined('+', sum, read_product());
      else if (take('-'))
        sum = combined('-', sum, read_product());
      else
        return sum;
    }
  }
  std::int64_t read_product() {
    std::int64_t product = read_atom();
    while (true) {
      skip();
      const char c = at_ < text_.size() ? text_[at_] : '\0';
      if (c != '*' && c != '/' && c != '%') return product;
      ++at_;
      product = combined(c, product, read_atom());
    }
  }
  std::int64_t read_atom() {
    if (++depth_ > deepest_sum) sound_ = false;
    if (!sound_) return 0;
    if (take('-')) return combined('-', 0, read_atom());
    if (take('(')) {
      const std::int64_t inner = read_sum();
      sound_ = sound_ && take(')');
      --depth_;
      return inner;
    }
    --depth_;
    skip();
    std::size_t end = at_;
    while (end < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[end])) != 0 || text_[end] == '_' ||
                                  text_[end] == '$' || text_[end] == '{' || text_[end] == '}'))
      ++end;
    std::string word(text_.substr(at_, end - at_));
    at_ = end;
    std::erase_if(word, [](char c) { return c == '$' || c == '{' || c == '}'; });
    if (!word.empty() && (word[0] < '0' || word[0] > '9')) word = lookup_(word);
    int base = 10;
    std::string_view digits = word;
    if (digits.starts_with("0x") || digits.starts_with("0X")) {
      digits.remove_prefix(2);
      base = 16;
    }
    std::int64_t number = 0;
    const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number, base);
    sound_ = sound_ && !digits.empty() && error == std::errc() && stop == digits.data() + digits.size();
    return number;
  }

  std::string_view text_;
  const Lookup& lookup_;
  std::size_t at_ = 0;
  std::uint32_t depth_ = 0;
  bool sound_ = true;
};

}  // namespace

std::optional<std::int64_t> shell_arithmetic(std::string_view text,
                                             const std::function<std::string(const std::string&)>& lookup) {
  return Arithmetic(text, lookup).value();
}

}  // namespace takt::interchange::linux_tc
