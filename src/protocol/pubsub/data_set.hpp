// SPDX-License-Identifier: Apache-2.0
// DataSet<T>: data that a Program publishes or subscribes to, as the application sees it.
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <tuple>
#include <vector>

#include "pubsub/field_type.hpp"

namespace takt::pubsub {

/// A DataSet as writers and readers see it: fields with types, in and out as Variants.
class AnyDataSet {
 public:
  virtual ~AnyDataSet() = default;
  virtual std::size_t field_count() const = 0;
  virtual uadp::RawField field(std::size_t index) const = 0;
  /// Writes a field as a Variant.
  virtual void put(uadp::Writer& writer, std::size_t index) const = 0;
  /// True if `take` would take it.
  virtual bool can_take(std::size_t index, const uadp::Variant& value) const = 0;
  virtual bool take(std::size_t index, const uadp::Variant& value) = 0;
  /// All fields of a message that have a value have been taken, and `status` says how good each one is: tells the
  /// application.
  virtual void notify() = 0;

  /// How good a field is that was received last: Good before anything has come. A field that is Uncertain has the value
  /// that came with it; one that is Bad has no value, and keeps the one before.
  uadp::Status status(std::size_t index) const { return index < statuses_.size() ? statuses_[index] : uadp::Status(); }
  /// Of the DataSet as a whole, from the header of the last message; Good if it says nothing.
  uadp::Status overall_status() const { return overall_; }
  /// Some field has no value.
  bool any_bad() const {
    return std::any_of(statuses_.begin(), statuses_.end(), [](uadp::Status each) { return each.is_bad(); });
  }
  /// For readers. Allocates the first time that a field is not Good.
  void set_status(std::size_t index, uadp::Status status) {
    if (statuses_.empty() && status == uadp::Status()) return;
    if (statuses_.empty()) statuses_.resize(field_count());
    statuses_[index] = status;
  }
  void set_overall_status(uadp::Status status) { overall_ = status; }

  /// Counts what the application has set; publishing on change looks at it.
  std::uint64_t version() const { return version_; }

 protected:
  void changed() { ++version_; }

 private:
  std::uint64_t version_ = 0;
  uadp::Status overall_;
  std::vector<uadp::Status> statuses_;  ///< by field; empty: all have always been Good
};

/// The fixed layout of a DataSet as RawData; nothing if a field has no fixed length.
std::optional<uadp::RawLayout> raw_layout_of(const AnyDataSet& data_set);

namespace detail {
template <class T>
struct FieldsOf {
  using Types = std::tuple<T>;
  static std::tuple<T&> in(T& value) { return std::tie(value); }
  static std::tuple<const T&> in(const T& value) { return std::tie(value); }
};
template <class... Ts>
struct FieldsOf<std::tuple<Ts...>> {
  using Types = std::tuple<Ts...>;
  static std::tuple<Ts&...> in(std::tuple<Ts...>& value) {
    return std::apply([](Ts&... each) { return std::tie(each...); }, value);
  }
  static std::tuple<const Ts&...> in(const std::tuple<Ts...>& value) {
    return std::apply([](const Ts&... each) { return std::tie(each...); }, value);
  }
};
}  // namespace detail

/// T is a scalar type of UADP (bool, the integers, float, double, DateTime, Guid, Status, std::string, BoundedString,
/// ByteString), a std::array or std::vector of one, or a std::tuple of all these: then each element is a field.
/// The object must live as long as the Publishers and Subscribers to which it was added.
template <class T>
class DataSet final : public AnyDataSet {
 public:
  using Fields = typename detail::FieldsOf<T>::Types;
  static constexpr std::size_t fields = std::tuple_size_v<Fields>;

  DataSet() = default;
  explicit DataSet(T value) : value_(std::move(value)) {}
  DataSet(const DataSet&) = delete;
  DataSet& operator=(const DataSet&) = delete;

  const T& get() const { return value_; }
  /// The value that goes out with the next message.
  void set(T value) {
    value_ = std::move(value);
    changed();
  }
  /// Called after each message with fields that was taken; `status` says how good they are. One call-back; a later one
  /// replaces it.
  void on_received(std::function<void(const T&)> call_back) { call_back_ = std::move(call_back); }

  std::size_t field_count() const override { return fields; }
  uadp::RawField field(std::size_t index) const override {
    uadp::RawField result;
    at<0>(index, [&]<std::size_t I>() { result = describe_field<std::tuple_element_t<I, Fields>>(); });
    return result;
  }
  void put(uadp::Writer& writer, std::size_t index) const override {
    const auto all = detail::FieldsOf<T>::in(value_);
    at<0>(index, [&]<std::size_t I>() { put_field(writer, std::get<I>(all)); });
  }
  bool can_take(std::size_t index, const uadp::Variant& value) const override {
    const auto all = detail::FieldsOf<T>::in(value_);
    bool fits = false;
    at<0>(index, [&]<std::size_t I>() {
      auto copy = std::get<I>(all);
      fits = accept_field(value, copy);
    });
    return fits;
  }
  bool take(std::size_t index, const uadp::Variant& value) override {
    auto all = detail::FieldsOf<T>::in(value_);
    bool taken = false;
    at<0>(index, [&]<std::size_t I>() { taken = accept_field(value, std::get<I>(all)); });
    return taken;
  }
  void notify() override {
    if (call_back_) call_back_(value_);
  }

 private:
  /// Calls `f` for the field with this index, which is known at run time only.
  template <std::size_t I, class F>
  static void at(std::size_t index, F&& f) {
    if constexpr (I < fields) {
      if (index == I)
        f.template operator()<I>();
      else
        at<I + 1>(index, f);
    }
  }

  T value_{};
  std::function<void(const T&)> call_back_;
};

}  // namespace takt::pubsub
