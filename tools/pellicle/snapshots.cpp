#include "tools/pellicle/snapshots.hpp"

#include <fmt/format.h>

#include <array>
#include <functional>
#include <numeric>
#include <stdexcept>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/hdf5_file.hpp"

namespace pellicle::tools {

namespace {

std::string data_item(const std::string& h5_path, const std::vector<std::size_t>& shape, bool integer) {
  return fmt::format(
      "<DataItem Dimensions=\"{}\" NumberType=\"{}\" Precision=\"{}\" Format=\"HDF\">{}</DataItem>\n",
      fmt::join(shape, " "), integer ? "Int" : "Float", integer ? 4 : 8, h5_path);
}

std::string attribute(const SnapshotArray& array, const std::string& h5_path, const char* center,
                      bool vector) {
  return fmt::format("<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">\n{}</Attribute>\n",
                     array.name, vector ? "Vector" : "Scalar", center,
                     data_item(h5_path, array.shape, array.integer));
}

// --- particles and parcels -------------------------------------------------------------------------------------

constexpr const char* rows_name = "rows";

/// A cloud of points. One of ParaView's readers takes a cloud for points, the other draws nothing unless each point is
/// named by a connectivity: the first rows of a data set that all snapshots share. An empty cloud gets one point
/// without data, since readers refuse a grid of nothing.
std::string describe_cloud(const std::string& h5_name, const SnapshotRecord& record, std::size_t rows) {
  const std::string base = h5_name + ":/" + record.group + "/";
  std::size_t count = 0;
  for (const auto& array : record.arrays) {
    if (array.name == "position") count = array.shape.front();
  }
  if (count == 0) {
    return "<Topology TopologyType=\"Polyvertex\" NumberOfElements=\"1\" NodesPerElement=\"1\">\n"
           "<DataItem Dimensions=\"1\" NumberType=\"Int\" Format=\"XML\">0</DataItem>\n</Topology>\n"
           "<Geometry GeometryType=\"XYZ\">\n<DataItem Dimensions=\"1 3\" Format=\"XML\">0 0 0</DataItem>\n"
           "</Geometry>\n";
  }
  std::string text = fmt::format(
      "<Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{0}\" NodesPerElement=\"1\">\n"
      "<DataItem ItemType=\"HyperSlab\" Dimensions=\"{0}\" NumberType=\"Int\">\n"
      "<DataItem Dimensions=\"3 1\" Format=\"XML\">0 1 {0}</DataItem>\n{1}</DataItem>\n</Topology>\n"
      "<Geometry GeometryType=\"XYZ\">\n{2}</Geometry>\n",
      count, data_item(fmt::format("{}:/{}", h5_name, rows_name), {rows}, true),
      data_item(base + "position", {count, 3}, false));
  for (const auto& array : record.arrays) {
    if (array.name == "position") continue;
    text += attribute(array, base + array.name, "Node", array.shape.size() == 2);
  }
  return text;
}

/// Writes one array with a value from each of `count` points.
template <class Value>
void write_per_point(core::Hdf5File& file, const std::string& name, std::size_t count, const Value& value) {
  using T = std::remove_cvref_t<decltype(value(std::size_t{0}))>;
  if constexpr (std::is_same_v<T, Vec3>) {
    std::vector<double> numbers(3 * count);
    for (std::size_t p = 0; p < count; ++p) {
      const Vec3 v = value(p);
      numbers[3 * p] = v.x;
      numbers[3 * p + 1] = v.y;
      numbers[3 * p + 2] = v.z;
    }
    file.write(name, std::span<const double>(numbers), std::array<std::size_t, 2>{count, 3});
  } else {
    std::vector<T> numbers(count);
    for (std::size_t p = 0; p < count; ++p) numbers[p] = value(p);
    file.write(name, std::span<const T>(numbers));
  }
}

void write_particle_field(core::Hdf5File& file, const std::string& group, const std::string& field,
                          const HostParticles& particles) {
  const std::string name = group + "/" + field;
  const auto put = [&](const auto& value) { write_per_point(file, name, particles.count(), value); };
  const auto& places = particles.position_radius;
  const auto& motions = particles.velocity_spin;
  if (field == "position") {
    put([&](std::size_t p) { return places[p].position(); });
  } else if (field == "id") {
    put([&](std::size_t p) { return motions[p].id; });
  } else if (field == "velocity") {
    put([&](std::size_t p) { return motions[p].velocity(); });
  } else if (field == "spin") {
    put([&](std::size_t p) { return motions[p].spin(); });
  } else if (field == "radius") {
    put([&](std::size_t p) { return places[p].radius; });
  } else if (field == "diameter") {
    put([&](std::size_t p) { return 2 * places[p].radius; });
  } else if (field == "mass") {
    put([&](std::size_t p) { return particles.mass[p]; });
  } else if (field == "material") {
    put([&](std::size_t p) { return motions[p].material; });
  } else if (field == "speed") {
    put([&](std::size_t p) { return norm(motions[p].velocity()); });
  } else if (field == "acceleration") {
    put([&](std::size_t p) { return convert<Real>(particles.sample(p).acceleration); });
  } else if (field == "temperature") {
    put([&](std::size_t p) { return particles.sample(p).temperature; });
  } else if (field == "film_liquid") {
    put([&](std::size_t p) { return particles.sample(p).film.liquid; });
  } else if (field == "film_solids") {
    put([&](std::size_t p) { return particles.sample(p).film.solids; });
  } else if (field == "coating_thickness") {
    put([&](std::size_t p) { return particles.sample(p).coating_thickness(); });
  } else if (field == "hits") {
    put([&](std::size_t p) { return static_cast<std::int32_t>(particles.sample(p).hit.hits); });
  } else {
    throw std::logic_error("no particle field " + field);
  }
}

void write_spray_field(core::Hdf5File& file, const std::string& group, const std::string& field,
                       const HostParcels& parcels) {
  const std::string name = group + "/" + field;
  const auto put = [&](const auto& value) { write_per_point(file, name, parcels.count(), value); };
  const auto& states = parcels.state;
  if (field == "position") {
    put([&](std::size_t i) { return states[i].position; });
  } else if (field == "id") {
    put([&](std::size_t i) { return static_cast<std::int32_t>(parcels.name[i].number); });
  } else if (field == "nozzle") {
    put([&](std::size_t i) { return parcels.name[i].nozzle; });
  } else if (field == "velocity") {
    put([&](std::size_t i) { return states[i].velocity; });
  } else if (field == "speed") {
    put([&](std::size_t i) { return norm(states[i].velocity); });
  } else if (field == "diameter") {
    put([&](std::size_t i) { return states[i].diameter; });
  } else if (field == "droplets") {
    put([&](std::size_t i) { return states[i].droplets; });
  } else if (field == "mass") {
    put([&](std::size_t i) { return parcels.mass[i]; });
  } else if (field == "liquid") {
    put([&](std::size_t i) { return parcels.liquid[i]; });
  } else if (field == "temperature") {
    put([&](std::size_t i) { return parcels.temperature[i]; });
  } else {
    throw std::logic_error("no spray field " + field);
  }
}

/// The position comes first, and once.
std::vector<std::string> with_position(std::vector<std::string> fields) {
  std::erase(fields, "position");
  fields.insert(fields.begin(), "position");
  return fields;
}

// --- gas -------------------------------------------------------------------------------------------------------

/// A rectilinear grid; XDMF counts its points, slowest index (z) first.
std::string describe_gas(const std::string& h5_name, const SnapshotRecord& record) {
  const auto& shape = record.arrays.front().shape;
  const std::array<std::size_t, 3> cells{shape.at(0), shape.at(1), shape.at(2)};
  std::string text = fmt::format(
      "<Topology TopologyType=\"3DRectMesh\" Dimensions=\"{} {} {}\"/>\n<Geometry "
      "GeometryType=\"VXVYVZ\">\n",
      cells[0] + 1, cells[1] + 1, cells[2] + 1);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    text += data_item(fmt::format("{}:/grid/{}", h5_name, "xyz"[axis]), {cells[2 - axis] + 1}, false);
  }
  text += "</Geometry>\n";
  for (const auto& array : record.arrays) {
    text +=
        attribute(array, h5_name + ":/" + record.group + "/" + array.name, "Cell", array.shape.size() == 4);
  }
  return text;
}

void write_gas_field(core::Hdf5File& file, const std::string& group, const std::string& field,
                     const GasFields& gas) {
  const GasFieldNumbers numbers = gas_field(gas, field);
  const std::vector<std::size_t> shape = gas_field_shape(*gas.grid, field);
  const std::size_t count = std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
  const std::string name = group + "/" + field;
  if (numbers.numbers != nullptr && !numbers.complement) {
    file.write(name, std::span<const double>(numbers.numbers, count), shape);
    return;
  }
  std::vector<double> values(count);
  for (std::size_t n = 0; n < count; ++n) values[n] = numbers(n);
  file.write(name, std::span<const double>(values), shape);
}

void write_grid(core::Hdf5File& file, const CartesianGrid& grid) {
  for (int axis = 0; axis < 3; ++axis) {
    file.write(fmt::format("grid/{}", "xyz"[axis]), std::span<const double>(grid.faces(axis)));
  }
}

}  // namespace

CloudSeries::CloudSeries(const std::filesystem::path& folder, const std::string& name,
                         std::optional<std::int64_t> resume_step)
    : series_(
          folder, name,
          [this](const std::string& h5_name, const SnapshotRecord& record) {
            return describe_cloud(h5_name, record, rows_);
          },
          resume_step) {
  if (series_.records().empty()) return;
  const std::vector<std::size_t> rows = series_.shape(rows_name);
  rows_ = rows.empty() ? 0 : rows.front();  // none if there never was a point
  series_.write_xdmf();
}

void CloudSeries::add(std::int64_t step, Real time, std::size_t count,
                      const std::function<void(core::Hdf5File&, const std::string& group)>& write) {
  series_.add(step, time, [&](core::Hdf5File& file, const std::string& group) {
    write(file, group);
    if (count <= rows_) return;
    rows_ = count;
    std::vector<std::int32_t> rows(rows_);
    std::iota(rows.begin(), rows.end(), 0);
    if (file.has(rows_name)) file.remove(rows_name);
    file.write(rows_name, std::span<const std::int32_t>(rows));
  });
}

ParticleSnapshots::ParticleSnapshots(const std::filesystem::path& folder, std::vector<std::string> fields,
                                     std::optional<std::int64_t> resume_step)
    : fields_(with_position(std::move(fields))), series_(folder, "particles", resume_step) {}

void ParticleSnapshots::write(std::int64_t step, Real time, const HostParticles& particles) {
  series_.add(step, time, particles.count(), [&](core::Hdf5File& file, const std::string& group) {
    for (const auto& field : fields_) write_particle_field(file, group, field, particles);
  });
}

SpraySnapshots::SpraySnapshots(const std::filesystem::path& folder, std::vector<std::string> fields,
                               std::optional<std::int64_t> resume_step)
    : fields_(with_position(std::move(fields))), series_(folder, "spray", resume_step) {}

void SpraySnapshots::write(std::int64_t step, Real time, const HostParcels& parcels) {
  series_.add(step, time, parcels.count(), [&](core::Hdf5File& file, const std::string& group) {
    for (const auto& field : fields_) write_spray_field(file, group, field, parcels);
  });
}

GasSnapshots::GasSnapshots(const std::filesystem::path& folder, std::vector<std::string> fields,
                           const CartesianGrid& grid, std::optional<std::int64_t> resume_step)
    : fields_(std::move(fields)), series_(folder, "gas", describe_gas, resume_step) {
  series_.write_once("grid", [&](core::Hdf5File& file) { write_grid(file, grid); });
  if (!series_.records().empty()) series_.write_xdmf();
}

void GasSnapshots::write(std::int64_t step, Real time, const GasFields& gas) {
  if (fields_.empty()) return;
  series_.add(step, time, [&](core::Hdf5File& file, const std::string& group) {
    for (const auto& field : fields_) write_gas_field(file, group, field, gas);
  });
}

void replace_gas_snapshot(const std::filesystem::path& folder, const std::string& name,
                          const CartesianGrid& grid, std::int64_t step, Real time,
                          const std::function<void(core::Hdf5File&, const std::string& group)>& write) {
  const std::string group = "average";
  const std::filesystem::path h5 = folder / (name + ".h5"), temporary = core::temporary_name(h5);
  SnapshotRecord record{group, step, time, {}};
  {
    core::Hdf5File file(temporary, core::Hdf5File::Mode::create);
    write_grid(file, grid);
    write(file, group);
    file.set_attribute(group, "step", step);
    file.set_attribute(group, "time", time);
    record.arrays = arrays_of(file, group);
    file.close();
  }
  std::error_code error;
  std::filesystem::rename(temporary, h5, error);
  if (error) throw RunError(h5.string() + ": cannot be replaced: " + error.message());
  write_xdmf(h5, {record}, describe_gas);
}

}  // namespace pellicle::tools
