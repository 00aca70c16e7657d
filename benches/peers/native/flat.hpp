// Reads the flat robot file of prepare.py. Its numbers are final: there is no trigonometry here.
#pragma once
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

struct FlatBody {
  double mass, com[3], inertia[6];  // in its link frame; xx yy zz xy xz yz about the centre of mass
};

struct FlatJoint : FlatBody {
  int parent;                       // -1: frame 0
  int prismatic;
  double before_R[9], before_p[3];  // placement of the joint in the link frame of its parent
  double after_R[9], after_p[3];    // link frame i seen from the frame that moves with the joint
};

struct FlatRobot {
  std::string name;
  double gravity[3];
  std::vector<FlatJoint> joints;
  bool floats;    // whether nothing holds frame 0, the frame of this body
  FlatBody base;
  bool branches() const {
    for (size_t i = 0; i < joints.size(); i++)
      if (joints[i].parent != int(i) - 1) return true;
    return false;
  }
};

inline FlatRobot read_flat(const std::string& dir, const std::string& robot) {
  const std::string path = dir + "/" + robot + ".txt";
  FILE* file = std::fopen(path.c_str(), "r");
  auto fail = [&] {
    std::fprintf(stderr, "cannot read %s\n", path.c_str());
    std::exit(2);
  };
  if (!file) fail();
  auto numbers = [&](double* x, int count) {
    for (int i = 0; i < count; i++)
      if (std::fscanf(file, "%lf", x + i) != 1) fail();
  };
  FlatRobot result;
  result.name = robot;
  int count = 0;
  if (std::fscanf(file, "%d", &count) != 1) fail();
  numbers(result.gravity, 3);
  for (int i = 0; i < count; i++) {
    FlatJoint joint;
    if (std::fscanf(file, "%d %d", &joint.parent, &joint.prismatic) != 2) fail();
    numbers(joint.before_R, 9), numbers(joint.before_p, 3), numbers(joint.after_R, 9), numbers(joint.after_p, 3);
    numbers(&joint.mass, 1), numbers(joint.com, 3), numbers(joint.inertia, 6);
    result.joints.push_back(joint);
  }
  result.floats = std::fscanf(file, "%lf", &result.base.mass) == 1;
  if (result.floats) numbers(result.base.com, 3), numbers(result.base.inertia, 6);
  std::fclose(file);
  return result;
}
