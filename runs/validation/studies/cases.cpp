// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/cases.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "runs/support/locations.hpp"
#include "runs/validation/studies/elliptic.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

namespace grouser::studies {

using base::Vec3d;

namespace {

using Values = std::vector<double>;
using Reference = std::function<Values(double)>;

/// Degrees to radians.
constexpr double kDegree = base::kPi / 180;

Values sum(const Vec3d& a, double s, const Vec3d& b, double t) {
  const Vec3d v = s * a + t * b;
  return {v.x, v.y, v.z};
}

/// Angle from the lowest position of a pendulum released at `amplitude`: theta'' = -rate^2 sin(theta).
struct Pendulum {
  double amplitude, rate;
  double angle(double t) const {
    const double k = std::sin(0.5 * amplitude);
    const Jacobi j = jacobi(rate * t, k);
    return 2 * std::asin(k * j.cn / j.dn); // sn(u + K) = cd(u)
  }
};

/// N four-bar linkages move like one pendulum that passes over the top. With the angle phi from the upright position:
/// [(N+1)/3 + N] phi'' = (g/L) [(N+1)/2 + N] sin(phi), phi'(0) = 1 rad/s.
struct Rotor {
  explicit Rotor(int n) {
    const double a = 9.81 * (0.5 * (n + 1) + n) / ((n + 1) / 3.0 + n);
    rate = 0.5 * std::sqrt(1 + 4 * a), k = std::sqrt(4 * a / (1 + 4 * a)), quarter = quarterPeriod(k);
  }
  /// The probes are position and velocity of the end of the first coupler.
  Values tip(double t) const {
    const Jacobi j = jacobi(rate * t - quarter, k);
    const double sine = -2 * j.sn * j.cn, cosine = 2 * j.sn * j.sn - 1, speed = 2 * rate * j.dn;
    return {sine, cosine, speed * cosine, -speed * sine};
  }
  double rate, k, quarter;
};

std::vector<Probe> point(const std::string& body, const Vec3d& p_B, const std::vector<int>& components,
                         Probe::Kind kind = Probe::kPosition) {
  std::vector<Probe> probes;
  for (const int c : components) probes.push_back({body, p_B, c, kind});
  return probes;
}

std::vector<Probe> both(std::vector<Probe> a, const std::vector<Probe>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

StudyCase fourbar(int n, double end) {
  const Rotor rotor(n);
  const std::vector<Probe> tip =
      both(point("upright 0", {0, 0.5, 0}, {0, 1}), point("upright 0", {0, 0.5, 0}, {0, 1}, Probe::kVelocity));
  return {fmt::format("fourbar{}", n),
          n <= 40 ? fmt::format("fourbar{}.toml", n) : fmt::format("fourbar {}", n),
          fmt::format("{} four-bar linkages (IFToMM A02), {:g} s", n, end),
          "closed form (one pendulum)",
          end,
          0.05,
          2,
          tip,
          [rotor](double t) { return rotor.tip(t); },
          n > 40};
}

StudyCase pendulum(const std::string& name, double end, double sample, int coarsest, bool isLong) {
  const Pendulum p{90 * kDegree, std::sqrt(9.81)};
  return {name,
          "pendulum.toml",
          fmt::format("simple pendulum (IFToMM A01), {:g} s", end),
          "closed form (Jacobi)",
          end,
          sample,
          coarsest,
          point("bob", {}, {0, 1}),
          [p](double t) {
            const double a = p.angle(t);
            return Values{std::sin(a), -std::cos(a)};
          },
          isLong};
}

StudyCase top(const std::string& name, const std::string& title, double sample, int coarsest) {
  return {name,
          name + ".toml",
          title,
          "DOP853 at 3e-14",
          20,
          sample,
          coarsest,
          both(point("top", {1, 0, 0}, {0, 1, 2}, Probe::kDirection),
               point("top", {0, 1, 0}, {0, 1, 2}, Probe::kDirection)),
          referenceFile(name + ".csv")};
}

StudyCase ring() {
  constexpr int kLinks = 46;
  constexpr double kSpin = 10, kPitch = 0.154;
  const double half = base::kPi / kLinks, apothem = kPitch / (2 * std::tan(half));
  return {"ring46",
          "ring46.toml",
          "ring of 46 track links spinning at 10 rad/s, 10 s",
          "closed form (rigid turn)",
          10,
          0.1,
          5,
          both(point("link 0", {}, {0, 2}), point("link 23", {}, {0, 2})),
          [=](double t) {
            const double a = half + kSpin * t, b = a + 46 * half;
            return Values{apothem * std::sin(a), apothem * std::cos(a), apothem * std::sin(b), apothem * std::cos(b)};
          }};
}

std::vector<StudyCase> joints() {
  std::vector<StudyCase> cases;
  const Pendulum rod{90 * kDegree, std::sqrt(9.80665 * 2 / 4.1)};
  cases.push_back({"revolute", "joint_revolute.toml", "rod on a hinge, released at 90 degrees, 5 s",
                   "closed form (Jacobi)", 5, 0.1, 1, point("rod", {}, {0, 2}), [rod](double t) {
                     const double a = rod.angle(t);
                     return Values{2 * std::sin(a), -2 * std::cos(a)};
                   }});
  const Pendulum weld{0.01, std::sqrt(2 * 9.81 / (8.0 / 3))};
  cases.push_back({"fixed", "joint_fixed.toml", "two rods welded, small swing, 5 s", "closed form (Jacobi)", 5, 0.1, 2,
                   point("lower", {}, {0}), [weld](double t) { return Values{1.5 * std::sin(weld.angle(t))}; }});
  cases.push_back({"prismatic", "joint_prismatic.toml", "block and spring on a slide, 5 s", "closed form (harmonic)", 5,
                   0.1, 2, point("block", {}, {0, 2}), [](double t) {
                     const double s = 0.04905 * (1 - std::cos(10 * t));
                     return Values{s * std::cos(30 * kDegree), -0.5 * s};
                   }});
  cases.push_back({"spherical", "joint_spherical.toml", "heavy top at 502.5 rad/s in steady precession, 2 s",
                   "closed form (circle)", 2, 0.02, 20, point("top", {}, {0, 1, 2}), [](double t) {
                     const double r = 0.1 * std::sin(60 * kDegree);
                     return Values{r * std::cos(2 * t), r * std::sin(2 * t), 0.05};
                   }});
  cases.push_back({"universal", "joint_universal.toml", "shafts at 30 degrees on a universal joint, 2 s",
                   "closed form (kinematics)", 2, 0.02, 2, point("output", {0, 1, 0}, {0, 1, 2}, Probe::kDirection),
                   [](double t) {
                     const Vec3d shaft{std::cos(30 * kDegree), 0, std::sin(30 * kDegree)};
                     const Vec3d arm{0, -std::sin(10 * t), std::cos(10 * t)};
                     return sum(normalized(cross(shaft, arm)), -1, {}, 0);
                   }});
  cases.push_back({"cylindrical", "joint_cylindrical.toml", "nut running down a screw, 1 s", "closed form (parabola)",
                   1, 0.02, 2, both(point("nut", {}, {2}), point("nut", {1, 0, 0}, {0, 1}, Probe::kDirection)),
                   [](double t) {
                     const double r = 0.1 / (2 * base::kPi), z = -0.5 * 9.81 * r * r / (r * r + 1e-3) * t * t;
                     return Values{z, std::cos(z / r), std::sin(z / r)};
                   }});
  cases.push_back({"torsion", "spring_torsion.toml", "wheel on a damped torsion spring, 3 s", "closed form (damped)", 3,
                   0.02, 2, point("wheel", {0, 0, 1}, {0, 2}, Probe::kDirection), [](double t) {
                     const double w = std::sqrt(396.0);
                     const double a = -0.3 + 0.3 * std::exp(-2 * t) * (std::cos(w * t) + 2 / w * std::sin(w * t));
                     return Values{std::sin(a), std::cos(a)};
                   }});
  cases.push_back(
      {"gears", "gears.toml", "two gear wheels under a torque, 2 s", "closed form (parabola)", 2, 0.02, 2,
       both(point("large", {0, 0, 1}, {0, 2}, Probe::kDirection), point("small", {0, 0, 1}, {0, 2}, Probe::kDirection)),
       [](double t) {
         const double a = 0.5 * 3 / 0.9 * t * t;
         return Values{std::sin(a), std::cos(a), std::sin(-2 * a), std::cos(-2 * a)};
       }});
  cases.push_back({"slidercrank", "slider_crank.toml", "slider-crank at 50 rad/s, 0.5 s", "closed form (kinematics)",
                   0.5, 0.005, 5, both(point("piston", {}, {0}), point("piston", {}, {0}, Probe::kVelocity)),
                   [](double t) {
                     const double s = std::sin(50 * t), c = std::cos(50 * t), root = std::sqrt(0.09 - 0.01 * s * s);
                     return Values{0.1 * c + root, -5 * s - 0.5 * s * c / root};
                   }});
  return cases;
}

/// Magnitude of the reaction force of a joint [N].
std::function<double(const coupling::Mechanism&)> forceOf(const std::string& joint) {
  return [joint](const coupling::Mechanism& m) {
    return norm(m.state().joint[static_cast<std::size_t>(m.model().jointIndex(joint))].force);
  };
}

} // namespace

std::vector<double> readProbes(const coupling::Mechanism& mechanism, const std::vector<Probe>& probes) {
  std::vector<double> values;
  for (const Probe& p : probes) {
    const auto b = static_cast<std::size_t>(mechanism.model().bodyIndex(p.body));
    const base::Pose& X = mechanism.state().pose[b];
    const multibody::Twist& V = mechanism.state().twist[b];
    const Vec3d arm = rotate(X.orientation, p.point_B);
    values.push_back((p.kind == Probe::kPosition    ? X.position + arm
                      : p.kind == Probe::kDirection ? arm
                                                    : V.v + cross(V.w, arm))[p.component]);
  }
  return values;
}

std::function<std::vector<double>(double t)> referenceFile(const std::string& name) {
  const std::filesystem::path path = support::shareFolder() / "runs" / "mechanisms" / "reference" / name;
  // The file is read on first use, so that a list of the cases does not require it.
  return [path, rows = std::map<long long, Values>()](double t) mutable {
    constexpr double kTick = 1e-7; // [s] resolution of times; finer than any interval between rows
    if (rows.empty()) {
      std::ifstream file(path);
      std::string line;
      std::getline(file, line);
      while (std::getline(file, line)) {
        std::istringstream words(line);
        Values values;
        for (std::string word; std::getline(words, word, ',');) values.push_back(std::stod(word));
        if (!values.empty()) rows[std::llround(values.front() / kTick)] = {values.begin() + 1, values.end()};
      }
    }
    const auto row = rows.find(std::llround(t / kTick));
    if (row == rows.end())
      throw base::InputError(
          fmt::format("{}: has no row at {} s; run make_reference.py in the folder of this file", path.string(), t));
    return row->second;
  };
}

std::vector<StudyCase> studyCases() {
  std::vector<StudyCase> cases;
  cases.push_back(pendulum("pendulum", 10, 0.1, 1, false));
  cases.push_back(pendulum("pendulum2000", 2000, 0.5, 5, true));
  cases.push_back(fourbar(2, 20));
  cases.push_back(fourbar(40, 20));
  cases.push_back(fourbar(1000, 10));
  const double crank = 0.007 - 9.2e-4, start = -.0617138900142764496;
  cases.push_back({"andrews", "andrews.toml", "Andrews' squeezing mechanism (IFToMM A03), 0.05 s", "DOP853 at 3e-14",
                   0.05, 2.5e-4, 1, point("K1", {crank * std::cos(start), crank * std::sin(start), 0}, {0, 1}),
                   referenceFile("andrews.csv")});
  cases.push_back(ring());
  cases.push_back(top("top_free", "free top with moments 1, 2, 3, 20 s", 0.1, 1));
  cases.push_back(top("top_flip", "free top flipping over (Dzhanibekov effect), 20 s", 0.1, 4));
  for (StudyCase& c : joints()) cases.push_back(std::move(c));
  return cases;
}

std::vector<ReactionCase> reactionCases() {
  const double half = base::kPi / 46, R = 0.154 / (2 * std::sin(half));
  return {
      {"ring46", "ring46.toml", "hinge of the spinning ring", 1, 1e-3, forceOf("pin 0"),
       18.02 * 100 * R * std::cos(half) / (2 * std::sin(half))},
      {"chain100", "chain100.toml", "top pin of 100 links of 1 kg with 1e6 kg at the end", 0.05, 5e-5, forceOf("pin 0"),
       1000100 * 9.81},
      {"chain100", "chain100.toml", "middle pin of the same chain", 0.05, 5e-5, forceOf("pin 50"), 1000050 * 9.81},
      {"strand12", "strand12.toml", "lowest pin of the sagging strand", 0.5, 1e-4, forceOf("pin 6"), 6381.7283},
      {"pulleys", "pulleys.toml", "belt strand, half of the 20 kN of the tensioner", 1, 1e-3, forceOf("upper strand"),
       10000},
  };
}

} // namespace grouser::studies
