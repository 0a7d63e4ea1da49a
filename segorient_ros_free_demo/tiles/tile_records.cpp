// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/tile_records.h"

#include <algorithm>

#include "tiles/packed_values.h"

namespace segorient::program {
namespace {

// A patch in the file. The joined field is a sum over many, which rounding hardly changes.
struct StoredPatch {
  float position[3];
  std::uint32_t normal;
  float spacing;
  float residual;
  std::int32_t piece;
  std::uint16_t points;
  std::uint16_t reliable;
};
constexpr unsigned kPatchNormalBits = 32;

StoredPatch storedOf(const TilePatch& patch) {
  StoredPatch s{};
  std::copy_n(patch.position, 3, s.position);
  s.normal = packNormal(patch.normal, kPatchNormalBits);
  s.spacing = patch.spacing;
  s.residual = patch.residual;
  s.piece = patch.piece;
  s.points = static_cast<std::uint16_t>(patch.points);
  s.reliable = static_cast<std::uint16_t>(patch.reliable);
  return s;
}

struct StoredFieldPoint {
  float position[3];
  std::uint32_t normal;
  std::int32_t piece;
  float confidence;
};

TilePatch patchOf(const StoredPatch& s) {
  TilePatch patch;
  std::copy_n(s.position, 3, patch.position);
  unpackNormal(s.normal, kPatchNormalBits, patch.normal);
  patch.spacing = s.spacing;
  patch.residual = s.residual;
  patch.piece = s.piece;
  patch.points = s.points;
  patch.reliable = s.reliable;
  return patch;
}

}  // namespace

void saveShare(const ShareFile& share, const std::string& path, std::uint64_t run,
               std::uint32_t tile) {
  TileFileWriter file(path, TileFileKind::SHARE, run, tile);
  file.list(share.piece_sizes);
  file.list(share.piece_signs);
  file.list(share.votes);
  file.commit();
}

ShareFile loadShare(const std::string& path, std::uint64_t run, std::uint32_t tile) {
  TileFileReader file(path, TileFileKind::SHARE, run, tile);
  ShareFile share;
  share.piece_sizes = file.list<std::uint32_t>();
  share.piece_signs = file.list<std::int8_t>();
  share.votes = file.list<TileVote>();
  file.end();
  return share;
}

void savePatches(const PatchFile& patches, const std::string& path, std::uint64_t run,
                 std::uint32_t tile) {
  TileFileWriter file(path, TileFileKind::PATCHES, run, tile);
  std::vector<StoredPatch> stored;
  stored.reserve(patches.patches.size());
  for (const TilePatch& patch : patches.patches) stored.push_back(storedOf(patch));
  file.list(stored);
  std::vector<StoredFieldPoint> points(patches.field_points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const FieldPoint& p = patches.field_points[i];
    std::copy_n(p.position, 3, points[i].position);
    points[i].normal = packNormal(p.normal, kPatchNormalBits);
    points[i].piece = p.piece;
    points[i].confidence = p.confidence;
  }
  file.list(points);
  file.list(patches.viewpoints);
  file.list(patches.normals);
  file.commit();
}

PatchFile loadPatches(const std::string& path, std::uint64_t run, std::uint32_t tile) {
  TileFileReader file(path, TileFileKind::PATCHES, run, tile);
  PatchFile patches;
  for (const StoredPatch& s : file.list<StoredPatch>()) patches.patches.push_back(patchOf(s));
  for (const StoredFieldPoint& s : file.list<StoredFieldPoint>()) {
    FieldPoint p;
    std::copy_n(s.position, 3, p.position);
    unpackNormal(s.normal, kPatchNormalBits, p.normal);
    p.piece = s.piece;
    p.confidence = s.confidence;
    patches.field_points.push_back(p);
  }
  patches.viewpoints = file.list<float>();
  patches.normals = file.list<float>();
  file.end();
  return patches;
}

void saveSigns(const SignsFile& signs, const std::string& path, std::uint64_t run,
               std::uint32_t tile) {
  TileFileWriter file(path, TileFileKind::SIGNS, run, tile);
  file.value(signs.again);
  file.value(signs.field);
  file.list(signs.signs.pieces);
  file.list(signs.signs.inside_out);
  // Without sensors, patches are turned as their pieces are.
  file.list(signs.signs.toward.empty() ? std::vector<std::int8_t>() : signs.signs.patches);
  file.list(signs.signs.toward);
  file.commit();
}

SignsFile loadSigns(const std::string& path, std::uint64_t run, std::uint32_t tile) {
  TileFileReader file(path, TileFileKind::SIGNS, run, tile);
  SignsFile signs;
  signs.again = file.value<bool>();
  signs.field = file.value<bool>();
  signs.signs.pieces = file.list<std::int8_t>();
  signs.signs.inside_out = file.list<std::uint8_t>();
  signs.signs.patches = file.list<std::int8_t>();
  signs.signs.toward = file.list<float>();
  file.end();
  return signs;
}

void saveField(const CloudField& field, const std::string& path, std::uint64_t run) {
  TileFileWriter file(path, TileFileKind::FIELD, run);
  file.value(field.radius);
  file.value(field.noise);
  file.value(field.averaged_below);
  file.list(field.cells);
  file.commit();
}

CloudField loadField(const std::string& path, std::uint64_t run) {
  TileFileReader file(path, TileFileKind::FIELD, run);
  CloudField field;
  field.radius = file.value<float>();
  field.noise = file.value<std::uint8_t>();
  field.averaged_below = file.value<float>();
  field.cells = file.list<FieldCell>();
  file.end();
  return field;
}

void saveLabels(const LabelFile& labels, const std::string& path, std::uint64_t run) {
  TileFileWriter file(path, TileFileKind::LABELS, run);
  for (const std::vector<std::uint32_t>& of_tile : labels) file.list(of_tile);
  file.commit();
}

LabelFile loadLabels(const std::string& path, std::uint64_t run, std::size_t tiles) {
  TileFileReader file(path, TileFileKind::LABELS, run);
  LabelFile labels(tiles);
  for (std::vector<std::uint32_t>& of_tile : labels) of_tile = file.list<std::uint32_t>();
  file.end();
  return labels;
}

}  // namespace segorient::program
