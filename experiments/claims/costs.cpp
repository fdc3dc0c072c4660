// Claims about time: ratios inside one run. On a processor they are told, not judged.
#include <cmath>
#include <string>

#include "experiments/claims/claim.h"
#include "experiments/claims/laboratory.h"

namespace penumbra::experiments::claims {
namespace {

/// Times that differ by less are alike.
constexpr double alike = 0.05;

double frame_of(Laboratory& lab, const std::string& scene, const std::string& technique,
                std::uint32_t size = 0) {
  return lab.value("frame_ms", scene, technique, Truth::none, size);
}

Outcome c01(Laboratory& lab) {
  const std::string scene = "sweep:10x100x1", fixed = ":bias_strategy=constant";
  Outcome outcome;
  double last = 0.0;
  for (const std::string id : {"shadow-map", "pcf-hardware-bilinear",
                               "pcf:filter=hardware-bilinear:kernel=3", "pcss-nearest"}) {
    const double ratio = frame_of(lab, scene, id + fixed) / frame_of(lab, scene, "none");
    outcome.number(id + " over none", ratio);
    if (last > 0.0) outcome.part(ratio >= last * (1.0 - alike));
    last = ratio;
  }
  return outcome;
}

Outcome c02(Laboratory& lab) {
  const std::string scene = "sweep:1x100x1";
  const double fixed =
      frame_of(lab, scene, "vsm-2007", 25) - frame_of(lab, scene, "shadow-map", 25);
  const double none = frame_of(lab, scene, "none", 25);
  Outcome outcome;
  outcome.number("ms of filtering at 25x25", fixed);
  outcome.number("none, ms", none);
  outcome.part(fixed > none);
  return outcome;
}

/// Time of a filter of so many texels over that of three.
double growth_of_kernel(Laboratory& lab, const std::string& technique, const char* key,
                        const char* least, const char* most) {
  const auto time = [&](const char* value) {
    return frame_of(lab, "boxes", technique + ":" + key + "=" + value);
  };
  return time(most) / time(least);
}

Outcome c06(Laboratory& lab) {
  Outcome outcome;
  const double area = growth_of_kernel(lab, "pcf:filter=box:map_size=1024", "kernel", "3", "15");
  const double linear = growth_of_kernel(lab, "vsm:map_size=1024", "blur", "1", "7");
  const double flat =
      growth_of_kernel(lab, "savsm:adaptive=false:map_size=1024", "kernel", "3", "15");
  outcome.number("PCF, 15 over 3 texels", area);
  outcome.number("VSM", linear);
  outcome.number("SAVSM", flat);
  outcome.part(area > linear);
  outcome.part(linear > flat);
  outcome.part(std::abs(flat - 1.0) < 2.0 * alike);
  return outcome;
}

Outcome c07(Laboratory& lab) {
  const auto ratio = [&](const char* a, const char* b) {
    return frame_of(lab, "boxes", a) / frame_of(lab, "boxes", b);
  };
  const double exponential = ratio("evsm:map_size=1024", "vsm:map_size=1024");
  const double parts =
      ratio("savsm:table=distributed:map_size=1024", "savsm:table=fp32:map_size=1024");
  Outcome outcome;
  outcome.number("EVSM over VSM (1.16 to 1.23)", exponential);
  outcome.number("distributed over fp32 (1.48)", parts);
  outcome.part(std::abs(exponential - 1.2) < 0.1);
  outcome.part(std::abs(parts - 1.48) < 0.15);
  return outcome;
}

Outcome c18(Laboratory& lab) {
  Outcome outcome;
  const auto chain = [&](const std::string& blur) {
    const std::string base = "vsm:map_size=1024:blur=" + blur + ":mips=";
    return frame_of(lab, "boxes", base + "true") / frame_of(lab, "boxes", base + "false");
  };
  const double none = chain("0"), wide = chain("16");
  outcome.number("mips over none, 1 texel (1.25)", none);
  outcome.number("33 texels (1.03)", wide);
  outcome.part(std::abs(none - 1.25) < 0.1);
  outcome.part(std::abs(wide - 1.03) < 0.05);
  return outcome;
}

Outcome c19(Laboratory& lab) {
  Outcome outcome;
  for (const int blur : {1, 4, 16}) {
    const std::string kernel = std::to_string(2 * blur + 1);
    const double ratio =
        frame_of(lab, "boxes", "vsm:map_size=1024:mips=false:blur=" + std::to_string(blur)) /
        frame_of(lab, "boxes", "savsm:adaptive=false:map_size=1024:kernel=" + kernel);
    outcome.number("blur over table, " + kernel + " texels", ratio);
    outcome.part(ratio < 1.0);
  }
  return outcome;
}

Outcome c20(Laboratory& lab) {
  Outcome outcome;
  const double table = frame_of(lab, "boxes", "savsm:adaptive=true:map_size=1024");
  const auto ratio = [&](const char* kernel) {
    const double filter = frame_of(
        lab, "boxes", std::string("pcf:filter=box:adaptive=true:map_size=1024:kernel=") + kernel);
    outcome.number(std::string("PCF over table, ") + kernel + " texels", filter / table);
    return filter / table;
  };
  outcome.part(ratio("3") < 1.0);
  outcome.part(ratio("9") > 1.0);
  return outcome;
}

Outcome c21(Laboratory& lab) {
  const double ratio = frame_of(lab, "boxes", "pcf-hardware-bilinear:bias_strategy=constant") /
                       frame_of(lab, "boxes", "shadow-map:bias_strategy=constant");
  Outcome outcome;
  outcome.number("bilinear over nearest", ratio);
  outcome.part(std::abs(ratio - 1.0) < alike);
  return outcome;
}

Outcome c22(Laboratory& lab) {
  const double ratio = frame_of(lab, "boxes", "shadow-map:map_size=1024") /
                       frame_of(lab, "boxes", "shadow-map:map_size=256");
  Outcome outcome;
  outcome.number("1024 over 256 texels", ratio);
  outcome.part(std::abs(ratio - 1.3) < 0.15);
  return outcome;
}

Outcome c26(Laboratory& lab) {
  const auto shading = [&](const char* technique, std::uint32_t size) {
    double ms = 0.0;
    for (const auto& pass : lab.row("boxes", technique, Truth::none, size).at("passes"))
      if (pass.at("name") == "shade") ms += pass.at("median_ms").get<double>();
    return ms;
  };
  Outcome outcome;
  const auto ratio = [&](std::uint32_t size) {
    const double value = shading("pcss-nearest", size) / shading("shadow-map", size);
    outcome.number("shading of PCSS over SSM at " + std::to_string(size), value);
    return value;
  };
  outcome.part(std::abs(ratio(25) - 4.0) < 2.0);
  outcome.part(std::abs(ratio(1200) - 10.0) < 3.0);
  return outcome;
}

Outcome c28(Laboratory& lab) {
  std::vector<std::pair<double, double>> points;
  Outcome outcome;
  for (const int objects : {1, 25, 50, 100, 200}) {
    const double ms = frame_of(lab, "sweep:" + std::to_string(objects) + "x100x1", "shadow-map");
    outcome.number("ms, " + std::to_string(objects) + " objects", ms);
    points.emplace_back(objects, ms);
  }
  double x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  const auto n = static_cast<double>(points.size());
  for (const auto& [a, b] : points) x += a, y += b, xx += a * a, xy += a * b, yy += b * b;
  const double r = (n * xy - x * y) / std::sqrt((n * xx - x * x) * (n * yy - y * y));
  outcome.number("R^2", r * r);
  outcome.part(r * r > 0.98);
  return outcome;
}

}  // namespace

std::vector<Claim> cost_claims() {
  return {
      {"C01", "S0 4.2.1", "SSM costs little over none; SSM, PCFb, PCFb3x3, PCSS in this order",
       "no ratio to none falls by over 5%, step by step", c01, Needs::gpu},
      {"C02", "S0 4.2.1", "VSM has a fixed filtering cost",
       "at 25x25 filtering takes longer than the frame without shadows", c02, Needs::gpu},
      {"C06", "S3 table 4.1",
       "PCF grows with the kernel's area, separable blurs linearly, SAVSM is flat",
       "from 3 to 15 texels PCF grows more than VSM; VSM more than SAVSM; SAVSM within 10%", c06,
       Needs::gpu},
      {"C07", "S3 table 4.1", "EVSM costs 1.16 to 1.23 of VSM, distributed SAVSM 1.48 of fp32",
       "1.2 within 0.1; 1.48 within 0.15", c07, Needs::gpu},
      {"C18", "S3 table 4.1", "mip chains cost VSM 1.25 at 1x1 and 1.03 at 33",
       "1.25 within 0.1; 1.03 within 0.05", c18, Needs::gpu},
      {"C19", "S3 table 4.1", "separable blurs beat tables at every width to 33",
       "ratio below 1 at 3; 9; 33 texels", c19, Needs::gpu},
      {"C20", "S3 table 4.1", "with variable width PCF falls behind the table between 3 and 9",
       "faster at 3; slower at 9", c20, Needs::gpu},
      {"C21", "S0 4.2.1, S4 2.2.9", "a bilinear comparison costs no more than a nearest one",
       "ratio 1 within 5%", c21, Needs::gpu},
      {"C22", "S4 2.2.9", "16 times the texels cost 1.3 times the frame", "1.3 within 0.15", c22,
       Needs::gpu},
      {"C26", "S0 4.2.1", "PCSS spends 4 (small) to 10 (1200x1200) times the shading of SSM",
       "4 within 2 at 25x25; 10 within 3 at 1200x1200", c26, Needs::gpu},
      {"C28", "S0 4.2.1", "time is linear in objects", "R^2 over 0.98 from 1 to 200 objects", c28,
       Needs::gpu},
  };
}

}  // namespace penumbra::experiments::claims
