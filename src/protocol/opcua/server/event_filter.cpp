// SPDX-License-Identifier: Apache-2.0
#include "opcua/server/event_filter.hpp"

#include <algorithm>
#include <array>

#include "opcua/server/numeric_range.hpp"

namespace takt::opcua {
namespace {

constexpr std::size_t most_elements = 64;
constexpr std::size_t any_number = 1000;
constexpr std::size_t most_range_octets = 64;

struct OperatorInfo {
  FilterOperator id;
  std::size_t least;
  std::size_t most;
};
/// How many operands each takes. The others are Bad_FilterOperatorUnsupported.
constexpr OperatorInfo operators[] = {{FilterOperator::Equals, 2, 2},
                                      {FilterOperator::IsNull, 1, 1},
                                      {FilterOperator::GreaterThan, 2, 2},
                                      {FilterOperator::LessThan, 2, 2},
                                      {FilterOperator::GreaterThanOrEqual, 2, 2},
                                      {FilterOperator::LessThanOrEqual, 2, 2},
                                      {FilterOperator::Not, 1, 1},
                                      {FilterOperator::Between, 3, 3},
                                      {FilterOperator::InList, 2, any_number},
                                      {FilterOperator::And, 2, 2},
                                      {FilterOperator::Or, 2, 2},
                                      {FilterOperator::OfType, 1, 1}};

const OperatorInfo* info_of(FilterOperator id) {
  const auto found =
      std::find_if(std::begin(operators), std::end(operators), [&](const OperatorInfo& each) { return each.id == id; });
  return found == std::end(operators) ? nullptr : found;
}

StatusCode check_clause(const SimpleAttributeOperand& clause, const AddressSpace& space) {
  if (space.find(clause.type_definition_id) == nullptr ||
      !space.is_subtype(clause.type_definition_id, NodeId(ids::base_event_type))) {
    // ConditionType is not known here; clients ask for the id of a condition all the same, and get null.
    const bool is_condition_id =
        clause.browse_path.empty() && clause.attribute_id == static_cast<std::uint32_t>(AttributeId::NodeId);
    return is_condition_id ? StatusCode::Good : StatusCode::BadNodeIdUnknown;
  }
  if (clause.browse_path.empty())
    return clause.attribute_id == static_cast<std::uint32_t>(AttributeId::NodeId) ? StatusCode::Good
                                                                                  : StatusCode::BadAttributeIdInvalid;
  if (clause.attribute_id != static_cast<std::uint32_t>(AttributeId::Value)) return StatusCode::BadAttributeIdInvalid;
  if (Variant nothing; clause.index_range.value.size() > most_range_octets ||
                       cut(nothing, clause.index_range) == StatusCode::BadIndexRangeInvalid)
    return StatusCode::BadIndexRangeInvalid;
  return event_field(path_of(clause.browse_path)) ? StatusCode::Good : StatusCode::BadNodeIdUnknown;
}

/// An operand is an element behind this one, a literal, or a field.
bool is_operand(const ExtensionObject& operand, std::size_t element, std::size_t elements) {
  if (const auto index = structure_in<ElementOperand>(operand))
    return index->index > element && index->index < elements;
  return structure_in<LiteralOperand>(operand) || structure_in<SimpleAttributeOperand>(operand);
}

StatusCode check_element(const ContentFilterElement& element, std::size_t index, std::size_t elements) {
  const OperatorInfo* const wanted = info_of(element.filter_operator);
  if (wanted == nullptr) return StatusCode::BadFilterOperatorUnsupported;
  if (element.filter_operands.size() < wanted->least || element.filter_operands.size() > wanted->most)
    return StatusCode::BadFilterOperandInvalid;
  const bool are_sound = std::all_of(element.filter_operands.begin(), element.filter_operands.end(),
                                     [&](const auto& each) { return is_operand(each, index, elements); });
  return are_sound ? StatusCode::Good : StatusCode::BadFilterOperandInvalid;
}

}  // namespace

FilterCheck check_filter(const EventFilter& filter, const AddressSpace& space, const Limits& limits) {
  FilterCheck check;
  std::size_t operands = 0;
  for (const ContentFilterElement& each : filter.where_clause.elements) operands += each.filter_operands.size();
  if (filter.select_clauses.size() > limits.select_clauses || operands > limits.where_operands) {
    check.has_errors = true;
    check.is_usable = false;
    return check;
  }
  std::size_t good = 0;
  for (const SimpleAttributeOperand& each : filter.select_clauses) {
    check.result.select_clause_results.push_back(check_clause(each, space));
    good += is_good(check.result.select_clause_results.back()) ? 1U : 0U;
  }
  check.has_errors = good < filter.select_clauses.size();
  check.is_usable = good > 0 && filter.where_clause.elements.size() <= most_elements;
  for (std::size_t i = 0; i < filter.where_clause.elements.size(); ++i) {
    const StatusCode status = check_element(filter.where_clause.elements[i], i, filter.where_clause.elements.size());
    check.result.where_clause_result.element_results.push_back({status, {}, {}});
    if (is_good(status)) continue;
    check.has_errors = true;
    check.is_usable = false;
  }
  return check;
}

DecodedFilter::DecodedFilter(const EventFilter& filter) {
  for (const SimpleAttributeOperand& each : filter.select_clauses) {
    const bool is_field = !each.browse_path.empty() && each.index_range.value.size() <= most_range_octets;
    selected_.push_back({is_field ? event_field(path_of(each.browse_path)) : std::nullopt,
                         is_field ? each.index_range.value : std::string()});
    octets_ += sizeof(FieldOperand) + selected_.back().range.size();
  }
  for (const ContentFilterElement& each : filter.where_clause.elements) {
    Element element{each.filter_operator, {}};
    for (const ExtensionObject& operand : each.filter_operands) element.operands.push_back(decoded(operand));
    steps_ += element.operands.size();
    octets_ += sizeof(Element);
    elements_.push_back(std::move(element));
  }
}

DecodedFilter::Operand DecodedFilter::decoded(const ExtensionObject& operand) {
  octets_ += sizeof(Operand) + operand.body.value.size();
  if (const auto element = structure_in<ElementOperand>(operand)) return ElementReference{element->index};
  if (auto literal = structure_in<LiteralOperand>(operand)) {
    octets_ += octets_of(literal->value);
    return std::move(literal->value);
  }
  const auto field = structure_in<SimpleAttributeOperand>(operand);
  const bool is_field = field && field->index_range.value.size() <= most_range_octets;
  return is_field ? FieldOperand{event_field(path_of(field->browse_path)), field->index_range.value} : FieldOperand();
}

namespace {

/// The value itself where it is whole; else the part of it, which `part` then holds.
const Variant& value_of(const FieldOperand& field, const EventRecord& record, Variant& part) {
  static const Variant none;
  if (!field.number) return none;
  const Variant& whole = record.field(*field.number);
  if (field.range.empty()) return whole;
  part = whole;
  return cut(part, field.range) == StatusCode::Good ? part : none;
}

/// Numbers of different types are compared as numbers.
bool are_equal(const Variant& a, const Variant& b) {
  const auto x = number_in(a), y = number_in(b);
  return x && y ? *x == *y : a == b;
}

}  // namespace

/// Asks a filter whose elements point behind themselves, so it ends; the answer of each element is kept.
class Question {
 public:
  Question(const DecodedFilter& filter, const EventRecord& record, const AddressSpace& space)
      : filter_(filter), record_(record), space_(space), answers_(filter.elements_.size()) {}

  bool holds(std::size_t index) {
    if (!answers_[index]) answers_[index] = evaluated(filter_.elements_[index]);
    return *answers_[index];
  }

 private:
  using Operands = std::vector<DecodedFilter::Operand>;

  /// Elements among the operands come first: what is compared then is not overwritten by them.
  bool evaluated(const DecodedFilter::Element& element) {
    const Operands& operands = element.operands;
    for (const auto& each : operands)
      if (const auto* const other = std::get_if<DecodedFilter::ElementReference>(&each)) holds(other->index);
    switch (element.operation) {
      case FilterOperator::And:
        return truth(operands[0]) && truth(operands[1]);
      case FilterOperator::Or:
        return truth(operands[0]) || truth(operands[1]);
      case FilterOperator::Not:
        return !truth(operands[0]);
      case FilterOperator::IsNull:
        return value(operands[0], parts_[0]).is_null();
      case FilterOperator::OfType:
        return is_of_type(value(operands[0], parts_[0]));
      case FilterOperator::Equals:
        return are_equal(value(operands[0], parts_[0]), value(operands[1], parts_[1]));
      case FilterOperator::InList:
        return is_in_list(operands);
      case FilterOperator::GreaterThan:
        return compare(operands, [](double a, double b) { return a > b; });
      case FilterOperator::LessThan:
        return compare(operands, [](double a, double b) { return a < b; });
      case FilterOperator::GreaterThanOrEqual:
        return compare(operands, [](double a, double b) { return a >= b; });
      case FilterOperator::LessThanOrEqual:
        return compare(operands, [](double a, double b) { return a <= b; });
      case FilterOperator::Between: {
        const auto at = number(operands[0]), least = number(operands[1]), most = number(operands[2]);
        return at && least && most && *at >= *least && *at <= *most;
      }
      default:
        return false;
    }
  }
  bool truth(const DecodedFilter::Operand& operand) {
    const bool* const flag = value(operand, parts_[0]).get<bool>();
    return flag != nullptr && *flag;
  }
  std::optional<double> number(const DecodedFilter::Operand& operand) { return number_in(value(operand, parts_[0])); }
  const Variant& value(const DecodedFilter::Operand& operand, Variant& part) {
    static const Variant answers[] = {Variant(false), Variant(true)};
    if (const auto* const element = std::get_if<DecodedFilter::ElementReference>(&operand))
      return answers[holds(element->index) ? 1 : 0];
    if (const auto* const literal = std::get_if<Variant>(&operand)) return *literal;
    return value_of(std::get<FieldOperand>(operand), record_, part);
  }
  bool is_of_type(const Variant& type) const {
    const NodeId* const id = type.get<NodeId>();
    return id != nullptr && space_.is_subtype(record_.event().type, *id);
  }
  bool is_in_list(const Operands& operands) {
    const Variant& wanted = value(operands[0], parts_[0]);
    return std::any_of(operands.begin() + 1, operands.end(),
                       [&](const auto& each) { return are_equal(wanted, value(each, parts_[1])); });
  }
  template <class Order>
  bool compare(const Operands& operands, Order order) {
    const auto a = number(operands[0]), b = number(operands[1]);
    return a && b && order(*a, *b);
  }

  const DecodedFilter& filter_;
  const EventRecord& record_;
  const AddressSpace& space_;
  std::vector<std::optional<bool>> answers_;
  std::array<Variant, 2> parts_;
};

bool DecodedFilter::lets_pass(const EventRecord& record, const AddressSpace& space) const {
  return elements_.empty() || Question(*this, record, space).holds(0);
}

List<Variant> DecodedFilter::selected_fields(const EventRecord& record) const {
  List<Variant> fields;
  fields.reserve(selected_.size());
  Variant part;
  for (const FieldOperand& each : selected_) fields.push_back(value_of(each, record, part));
  return fields;
}

}  // namespace takt::opcua
