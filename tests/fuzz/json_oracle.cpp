/* json_oracle.cpp - reads reports by nlohmann's parser. */
#include "json_oracle.h"
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

using nlohmann::json;

struct json_oracle {
    json value;
};

json_oracle *oracle_read(const char *text, size_t size, bool *too_large)
{
    std::vector<std::set<std::string>> keys;
    bool twice = false;
    const auto watch = [&](int, json::parse_event_t event, json &value) {
        if (event == json::parse_event_t::object_start)
            keys.emplace_back();
        else if (event == json::parse_event_t::object_end)
            keys.pop_back();
        else if (event == json::parse_event_t::key)
            twice = !keys.back().insert(value.get<std::string>()).second || twice;
        return true;
    };
    *too_large = false;
    /* It would skip a byte order mark. */
    if (size >= 3 && std::string(text, 3) == "\xef\xbb\xbf")
        return nullptr;
    try {
        json value = json::parse(text, text + size, watch);
        return twice ? nullptr : new json_oracle{std::move(value)};
    } catch (const json::out_of_range &) {
        *too_large = true;
    } catch (const json::exception &) {
    }
    return nullptr;
}

void oracle_free(json_oracle *oracle)
{
    delete oracle;
}

static bool is_text_or_null(const json &object, const char *key)
{
    return object.contains(key) && (object[key].is_string() || object[key].is_null());
}

static bool is_entry(const json &entry)
{
    if (!entry.is_object() || !is_text_or_null(entry, "input") || !is_text_or_null(entry, "output") ||
        !is_text_or_null(entry, "error") || !entry.contains("status") || !entry.contains("exit") ||
        !entry["exit"].is_number())
        return false;
    const json &status = entry["status"];
    const double code = entry["exit"].get<double>();
    return code >= 0 && code <= 7 && code == static_cast<int>(code) &&
           (status == "ok" || status == "failed" || status == "skipped");
}

bool oracle_is_report(const json_oracle *oracle)
{
    const json &root = oracle->value;
    if (!root.is_object() || root.size() != 3 || !root.contains("format") || !root.contains("version") ||
        !root.contains("jobs") || root["format"] != "ffd-report" || root["version"] != 1 ||
        !root["jobs"].is_array())
        return false;
    for (const json &entry : root["jobs"])
        if (!is_entry(entry))
            return false;
    return true;
}

size_t oracle_count_jobs(const json_oracle *oracle)
{
    return oracle->value["jobs"].size();
}

bool oracle_job_is(const json_oracle *oracle, size_t job, const json_oracle *value)
{
    return oracle->value["jobs"].at(job) == value->value;
}
