// SPDX-License-Identifier: Apache-2.0
#include "tests/generator/schema_validation.hpp"

#include <memory>
#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "scenario/description/description.hpp"

namespace takt::generator {

using valijson::adapters::NlohmannJsonAdapter;

std::string refused_by_schema(const std::string& text) {
  static const nlohmann::json source = nlohmann::json::parse(json::schema<scenario::Scenario>("takt scenario"));
  static const auto schema = [] {
    auto parsed = std::make_unique<valijson::Schema>();
    const NlohmannJsonAdapter adapter(source);
    valijson::SchemaParser(valijson::SchemaParser::kDraft7).populateSchema(adapter, *parsed);
    return parsed;
  }();
  const auto value = nlohmann::json::parse(text, nullptr, true, true);
  const NlohmannJsonAdapter adapter(value);
  valijson::ValidationResults results;
  if (valijson::Validator().validate(*schema, adapter, &results)) return {};
  std::string all;
  for (const valijson::ValidationResults::Error& error : results) {
    for (const std::string& step : error.context) all += step;
    all += ": " + error.description + "\n";
  }
  return all.empty() ? "refused" : all;
}

}  // namespace takt::generator
