"""The sparse voxel octree: voxelized, built, lit and filtered on the GPU. [Mittring12]"""
