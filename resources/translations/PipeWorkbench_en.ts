<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="en" sourcelanguage="en">
    <context>
        <name>App::Property</name>
        <message>
            <source>A fitting (tee) or a branch welded on (set-on)</source>
            <translation>A fitting (tee) or a branch welded on (set-on)</translation>
        </message>
        <message>
            <source>Between the run's direction and the branch</source>
            <translation>Between the run's direction and the branch</translation>
        </message>
        <message>
            <source>Change of direction</source>
            <translation>Change of direction</translation>
        </message>
        <message>
            <source>Diameter D of the plate</source>
            <translation>Diameter D of the plate</translation>
        </message>
        <message>
            <source>Diameter K of the bolt circle; 0 where it is not known</source>
            <translation>Diameter K of the bolt circle; 0 where it is not known</translation>
        </message>
        <message>
            <source>Diameter L of a bolt hole; 0 where it is not known</source>
            <translation>Diameter L of a bolt hole; 0 where it is not known</translation>
        </message>
        <message>
            <source>Diameter of the neck where it leaves the plate; 0 for the pipe's</source>
            <translation>Diameter of the neck where it leaves the plate; 0 for the pipe's</translation>
        </message>
        <message>
            <source>Diameter of the raised face; 0 where it is not known</source>
            <translation>Diameter of the raised face; 0 where it is not known</translation>
        </message>
        <message>
            <source>Draw the bolts, through a partner of the same thickness</source>
            <translation>Draw the bolts, through a partner of the same thickness</translation>
        </message>
        <message>
            <source>Files of the photographs</source>
            <translation>Files of the photographs</translation>
        </message>
        <message>
            <source>Flanges of the same dimensions, which images cannot tell apart</source>
            <translation>Flanges of the same dimensions, which images cannot tell apart</translation>
        </message>
        <message>
            <source>From the branch's axis to the end of the run</source>
            <translation>From the branch's axis to the end of the run</translation>
        </message>
        <message>
            <source>From the branch's axis to the start of the run</source>
            <translation>From the branch's axis to the start of the run</translation>
        </message>
        <message>
            <source>From the face to the weld end</source>
            <translation>From the face to the weld end</translation>
        </message>
        <message>
            <source>From the run's axis to the end of the branch</source>
            <translation>From the run's axis to the end of the branch</translation>
        </message>
        <message>
            <source>From the weld end to the top</source>
            <translation>From the weld end to the top</translation>
        </message>
        <message>
            <source>Height of the raised face</source>
            <translation>Height of the raised face</translation>
        </message>
        <message>
            <source>How well the standard's dimensions are sourced</source>
            <translation>How well the standard's dimensions are sourced</translation>
        </message>
        <message>
            <source>Identity in exchange files</source>
            <translation>Identity in exchange files</translation>
        </message>
        <message>
            <source>Index of the pick that made the component, -1 for none</source>
            <translation>Index of the pick that made the component, -1 for none</translation>
        </message>
        <message>
            <source>Keep the component as it is when its pick is reconstructed again</source>
            <translation>Keep the component as it is when its pick is reconstructed again</translation>
        </message>
        <message>
            <source>Length along the axis</source>
            <translation>Length along the axis</translation>
        </message>
        <message>
            <source>Length of the neck's straight part at the weld end</source>
            <translation>Length of the neck's straight part at the weld end</translation>
        </message>
        <message>
            <source>Level of accuracy (USIBD)</source>
            <translation>Level of accuracy (USIBD)</translation>
        </message>
        <message>
            <source>Name in exchange files</source>
            <translation>Name in exchange files</translation>
        </message>
        <message>
            <source>Names of the cameras</source>
            <translation>Names of the cameras</translation>
        </message>
        <message>
            <source>Nominal diameter of the standard</source>
            <translation>Nominal diameter of the standard</translation>
        </message>
        <message>
            <source>Number of bolts; 0 where it is not known</source>
            <translation>Number of bolts; 0 where it is not known</translation>
        </message>
        <message>
            <source>Of the narrow end across the axis, where it is eccentric</source>
            <translation>Of the narrow end across the axis, where it is eccentric</translation>
        </message>
        <message>
            <source>Outside diameter</source>
            <translation>Outside diameter</translation>
        </message>
        <message>
            <source>Outside diameter of the branch</source>
            <translation>Outside diameter of the branch</translation>
        </message>
        <message>
            <source>Outside diameter of the narrow end</source>
            <translation>Outside diameter of the narrow end</translation>
        </message>
        <message>
            <source>PN</source>
            <translation>PN</translation>
        </message>
        <message>
            <source>RMS distance to the image edges in pixels (Eq. 4)</source>
            <translation>RMS distance to the image edges in pixels (Eq. 4)</translation>
        </message>
        <message>
            <source>Radius of the bent axis</source>
            <translation>Radius of the bent axis</translation>
        </message>
        <message>
            <source>Standard deviation of the direction</source>
            <translation>Standard deviation of the direction</translation>
        </message>
        <message>
            <source>Standard deviation of the measured diameter</source>
            <translation>Standard deviation of the measured diameter</translation>
        </message>
        <message>
            <source>Standard deviation of the middle along x, y, z in mm</source>
            <translation>Standard deviation of the middle along x, y, z in mm</translation>
        </message>
        <message>
            <source>Standard deviation of unit weight of the adjustment, 0 for none</source>
            <translation>Standard deviation of unit weight of the adjustment, 0 for none</translation>
        </message>
        <message>
            <source>Standard of the dimensions</source>
            <translation>Standard of the dimensions</translation>
        </message>
        <message>
            <source>Standard size within 3 sigma of a free diameter</source>
            <translation>Standard size within 3 sigma of a free diameter</translation>
        </message>
        <message>
            <source>Starts and ends, in mm from the pipe's start, of what was bridged</source>
            <translation>Starts and ends, in mm from the pipe's start, of what was bridged</translation>
        </message>
        <message>
            <source>Station in whose level frame the components are</source>
            <translation>Station in whose level frame the components are</translation>
        </message>
        <message>
            <source>Station that measured the component</source>
            <translation>Station that measured the component</translation>
        </message>
        <message>
            <source>Stations that measured the components</source>
            <translation>Stations that measured the components</translation>
        </message>
        <message>
            <source>The component that was measured, and how it was modelled (JSON)</source>
            <translation>The component that was measured, and how it was modelled (JSON)</translation>
        </message>
        <message>
            <source>The ends do not lie on one axis</source>
            <translation>The ends do not lie on one axis</translation>
        </message>
        <message>
            <source>The images do not support the pipe well</source>
            <translation>The images do not support the pipe well</translation>
        </message>
        <message>
            <source>The pipeline without its components (JSON)</source>
            <translation>The pipeline without its components (JSON)</translation>
        </message>
        <message>
            <source>Thickness C of the plate, raised face included</source>
            <translation>Thickness C of the plate, raised face included</translation>
        </message>
        <message>
            <source>Type of EN 1092-1 (01 plate, 05 blind, 11 weld neck, ...)</source>
            <translation>Type of EN 1092-1 (01 plate, 05 blind, 11 weld neck, ...)</translation>
        </message>
        <message>
            <source>Type of the standard (2D, 3D, 5D)</source>
            <translation>Type of the standard (2D, 3D, 5D)</translation>
        </message>
        <message>
            <source>Version of this object's properties</source>
            <translation>Version of this object's properties</translation>
        </message>
        <message>
            <source>Wall thickness; 0 where it is not known</source>
            <translation>Wall thickness; 0 where it is not known</translation>
        </message>
        <message>
            <source>Which ends are joined: component and number of its end</source>
            <translation>Which ends are joined: component and number of its end</translation>
        </message>
        <message>
            <source>station.json with the calibration of the cameras</source>
            <translation>station.json with the calibration of the cameras</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_ExampleProject</name>
        <message>
            <source>Example project: dummy station</source>
            <translation>Example project: dummy station</translation>
        </message>
        <message>
            <source>Open an example with photographs, and a guide through the first steps</source>
            <translation>Open an example with photographs, and a guide through the first steps</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_Export</name>
        <message>
            <source>Export</source>
            <translation>Export</translation>
        </message>
        <message>
            <source>Export pipes and fittings (all, or those selected) as IFC, STEP, JSON, CSV or as a picture</source>
            <translation>Export pipes and fittings (all, or those selected) as IFC, STEP, JSON, CSV or as a picture</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_ImportStation</name>
        <message>
            <source>Import Station</source>
            <translation>Import Station</translation>
        </message>
        <message>
            <source>Import the photographs and the calibration of a station (station.json)</source>
            <translation>Import the photographs and the calibration of a station (station.json)</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_PhotoWindow</name>
        <message>
            <source>Photo Window</source>
            <translation>Photo Window</translation>
        </message>
        <message>
            <source>Show the station's photographs side by side, with the contours of pipes and fittings</source>
            <translation>Show the station's photographs side by side, with the contours of pipes and fittings</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_Preferences</name>
        <message>
            <source>Preferences ...</source>
            <translation>Preferences ...</translation>
        </message>
        <message>
            <source>Tables of your own, working range, tolerances, colours and threads</source>
            <translation>Tables of your own, working range, tolerances, colours and threads</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_ReconstructPicks</name>
        <message>
            <source>Reconstruct Picks</source>
            <translation>Reconstruct Picks</translation>
        </message>
        <message>
            <source>Reconstruct the pipes that were picked in the station's photographs (picks.json)</source>
            <translation>Reconstruct the pipes that were picked in the station's photographs (picks.json)</translation>
        </message>
    </context>
    <context>
        <name>PipeWorkbench</name>
        <message>
            <source>A folder with tables of your own</source>
            <translation>A folder with tables of your own</translation>
        </message>
        <message>
            <source>A pipe whose measured diameter differs by more from the standard's is marked as approximate</source>
            <translation>A pipe whose measured diameter differs by more from the standard's is marked as approximate</translation>
        </message>
        <message>
            <source>A station is a calibrated rig of cameras and its photographs, described by station.json. That of the example is in the document.</source>
            <translation>A station is a calibrated rig of cameras and its photographs, described by station.json. That of the example is in the document.</translation>
        </message>
        <message>
            <source>A weak condition: what the images say clearly is stronger</source>
            <translation>A weak condition: what the images say clearly is stronger</translation>
        </message>
        <message>
            <source>Add ...</source>
            <translation>Add ...</translation>
        </message>
        <message>
            <source>Add a flange</source>
            <translation>Add a flange</translation>
        </message>
        <message>
            <source>Add a folder with tables</source>
            <translation>Add a folder with tables</translation>
        </message>
        <message>
            <source>Adjust everything</source>
            <translation>Adjust everything</translation>
        </message>
        <message>
            <source>Adjustment</source>
            <translation>Adjustment</translation>
        </message>
        <message>
            <source>Approximate from a deviation of</source>
            <translation>Approximate from a deviation of</translation>
        </message>
        <message>
            <source>Approximate pipe</source>
            <translation>Approximate pipe</translation>
        </message>
        <message>
            <source>Bad</source>
            <translation>Bad</translation>
        </message>
        <message>
            <source>Cancel</source>
            <translation>Cancel</translation>
        </message>
        <message>
            <source>Cancelling: waiting for the end of this step ...</source>
            <translation>Cancelling: waiting for the end of this step ...</translation>
        </message>
        <message>
            <source>Cap</source>
            <translation>Cap</translation>
        </message>
        <message>
            <source>Choose the tool and click on both edges of a pipe in one photograph, or once inside it. The proposed pipe is drawn into all photographs; Enter accepts it, digits choose another proposal, Esc steps back.</source>
            <translation>Choose the tool and click on both edges of a pipe in one photograph, or once inside it. The proposed pipe is drawn into all photographs; Enter accepts it, digits choose another proposal, Esc steps back.</translation>
        </message>
        <message>
            <source>Click on a flange of a pipe, then choose its type and pressure class from those that fit.</source>
            <translation>Click on a flange of a pipe, then choose its type and pressure class from those that fit.</translation>
        </message>
        <message>
            <source>Click to choose another colour</source>
            <translation>Click to choose another colour</translation>
        </message>
        <message>
            <source>Close the guide; the document stays open</source>
            <translation>Close the guide; the document stays open</translation>
        </message>
        <message>
            <source>Colours</source>
            <translation>Colours</translation>
        </message>
        <message>
            <source>Computer</source>
            <translation>Computer</translation>
        </message>
        <message>
            <source>Distance of the farthest pipes from the cameras</source>
            <translation>Distance of the farthest pipes from the cameras</translation>
        </message>
        <message>
            <source>Distance of the nearest pipes from the cameras</source>
            <translation>Distance of the nearest pipes from the cameras</translation>
        </message>
        <message>
            <source>Down</source>
            <translation>Down</translation>
        </message>
        <message>
            <source>Elbow</source>
            <translation>Elbow</translation>
        </message>
        <message>
            <source>Elbows are found from the pipes' axes; choose the bend radius that fits the photographs.</source>
            <translation>Elbows are found from the pipes' axes; choose the bend radius that fits the photographs.</translation>
        </message>
        <message>
            <source>End the tour</source>
            <translation>End the tour</translation>
        </message>
        <message>
            <source>Ends that face each other and are not farther apart are joined</source>
            <translation>Ends that face each other and are not farther apart are joined</translation>
        </message>
        <message>
            <source>Exactly as in the standard</source>
            <translation>Exactly as in the standard</translation>
        </message>
        <message>
            <source>Example project</source>
            <translation>Example project</translation>
        </message>
        <message>
            <source>Export it</source>
            <translation>Export it</translation>
        </message>
        <message>
            <source>Fair</source>
            <translation>Fair</translation>
        </message>
        <message>
            <source>Fair up to</source>
            <translation>Fair up to</translation>
        </message>
        <message>
            <source>First steps</source>
            <translation>First steps</translation>
        </message>
        <message>
            <source>Flange</source>
            <translation>Flange</translation>
        </message>
        <message>
            <source>Folders with CSV files of your own; a table takes the place of the same one further up and of the standards'</source>
            <translation>Folders with CSV files of your own; a table takes the place of the same one further up and of the standards'</translation>
        </message>
        <message>
            <source>Free, as measured</source>
            <translation>Free, as measured</translation>
        </message>
        <message>
            <source>From photographs to a pipeline. Each step is checked off when the document shows it done; undo opens it again.</source>
            <translation>From photographs to a pipeline. Each step is checked off when the document shows it done; undo opens it again.</translation>
        </message>
        <message>
            <source>Good</source>
            <translation>Good</translation>
        </message>
        <message>
            <source>Good up to</source>
            <translation>Good up to</translation>
        </message>
        <message>
            <source>How many parts of the processor are used at most</source>
            <translation>How many parts of the processor are used at most</translation>
        </message>
        <message>
            <source>How near to an edge the pointer must be, in pixels of the screen</source>
            <translation>How near to an edge the pointer must be, in pixels of the screen</translation>
        </message>
        <message>
            <source>How the adjustment treats diameters and bend radii of the standards</source>
            <translation>How the adjustment treats diameters and bend radii of the standards</translation>
        </message>
        <message>
            <source>Import a station</source>
            <translation>Import a station</translation>
        </message>
        <message>
            <source>Join ends up to</source>
            <translation>Join ends up to</translation>
        </message>
        <message>
            <source>Kinds of components</source>
            <translation>Kinds of components</translation>
        </message>
        <message>
            <source>Limit of Baarda's test; 3.29 takes one good observation of a thousand for an outlier</source>
            <translation>Limit of Baarda's test; 3.29 takes one good observation of a thousand for an outlier</translation>
        </message>
        <message>
            <source>Measure a pipe</source>
            <translation>Measure a pipe</translation>
        </message>
        <message>
            <source>Measure the pipe around the corner</source>
            <translation>Measure the pipe around the corner</translation>
        </message>
        <message>
            <source>Measure the pipe that goes on behind a bend of the first one.</source>
            <translation>Measure the pipe that goes on behind a bend of the first one.</translation>
        </message>
        <message>
            <source>Measuring</source>
            <translation>Measuring</translation>
        </message>
        <message>
            <source>Move the chosen folder down: its tables come before those above</source>
            <translation>Move the chosen folder down: its tables come before those above</translation>
        </message>
        <message>
            <source>Move the chosen folder up</source>
            <translation>Move the chosen folder up</translation>
        </message>
        <message>
            <source>Not measured</source>
            <translation>Not measured</translation>
        </message>
        <message>
            <source>Open its photo window</source>
            <translation>Open its photo window</translation>
        </message>
        <message>
            <source>Outliers from</source>
            <translation>Outliers from</translation>
        </message>
        <message>
            <source>Outside diameters from</source>
            <translation>Outside diameters from</translation>
        </message>
        <message>
            <source>Pick {index} failed: {reason}.</source>
            <translation>Pick {index} failed: {reason}.</translation>
        </message>
        <message>
            <source>Picks</source>
            <translation>Picks</translation>
        </message>
        <message>
            <source>Pipe</source>
            <translation>Pipe</translation>
        </message>
        <message>
            <source>Pipes from</source>
            <translation>Pipes from</translation>
        </message>
        <message>
            <source>Pipes that are nearly level, plumb or at right angles are so</source>
            <translation>Pipes that are nearly level, plumb or at right angles are so</translation>
        </message>
        <message>
            <source>Poor</source>
            <translation>Poor</translation>
        </message>
        <message>
            <source>Poor up to</source>
            <translation>Poor up to</translation>
        </message>
        <message>
            <source>Put the elbow between them</source>
            <translation>Put the elbow between them</translation>
        </message>
        <message>
            <source>Quality</source>
            <translation>Quality</translation>
        </message>
        <message>
            <source>Quality is the root mean square distance of a component's contour from the edges in the photographs</source>
            <translation>Quality is the root mean square distance of a component's contour from the edges in the photographs</translation>
        </message>
        <message>
            <source>Reconstruct picks</source>
            <translation>Reconstruct picks</translation>
        </message>
        <message>
            <source>Reconstructing picks</source>
            <translation>Reconstructing picks</translation>
        </message>
        <message>
            <source>Reducer</source>
            <translation>Reducer</translation>
        </message>
        <message>
            <source>Remove</source>
            <translation>Remove</translation>
        </message>
        <message>
            <source>Restore defaults</source>
            <translation>Restore defaults</translation>
        </message>
        <message>
            <source>Set everything on this page to what it was at first</source>
            <translation>Set everything on this page to what it was at first</translation>
        </message>
        <message>
            <source>Snap to edges within</source>
            <translation>Snap to edges within</translation>
        </message>
        <message>
            <source>Something else is still being computed; wait for its end or cancel it</source>
            <translation>Something else is still being computed; wait for its end or cancel it</translation>
        </message>
        <message>
            <source>Standard sizes</source>
            <translation>Standard sizes</translation>
        </message>
        <message>
            <source>Station</source>
            <translation>Station</translation>
        </message>
        <message>
            <source>Station {name}: {count} components reconstructed</source>
            <translation>Station {name}: {count} components reconstructed</translation>
        </message>
        <message>
            <source>Station {name}: {count} photographs imported</source>
            <translation>Station {name}: {count} photographs imported</translation>
        </message>
        <message>
            <source>Tables of your own</source>
            <translation>Tables of your own</translation>
        </message>
        <message>
            <source>Take the chosen folder from the list; its files stay</source>
            <translation>Take the chosen folder from the list; its files stay</translation>
        </message>
        <message>
            <source>Tee</source>
            <translation>Tee</translation>
        </message>
        <message>
            <source>That is all. Import photographs of your own with Import Station.</source>
            <translation>That is all. Import photographs of your own with Import Station.</translation>
        </message>
        <message>
            <source>The adjustment fits all components to the edges of all photographs at once and makes the pipeline continuous.</source>
            <translation>The adjustment fits all components to the edges of all photographs at once and makes the pipeline continuous.</translation>
        </message>
        <message>
            <source>The photo window shows the station's photographs side by side. Turn the wheel to zoom at the pointer, drag with the middle button to move the photographs.</source>
            <translation>The photo window shows the station's photographs side by side. Turn the wheel to zoom at the pointer, drag with the middle button to move the photographs.</translation>
        </message>
        <message>
            <source>The preferences are not changed. {error}</source>
            <translation>The preferences are not changed. {error}</translation>
        </message>
        <message>
            <source>Thicker pipes are not looked for</source>
            <translation>Thicker pipes are not looked for</translation>
        </message>
        <message>
            <source>Thinner pipes are not looked for</source>
            <translation>Thinner pipes are not looked for</translation>
        </message>
        <message>
            <source>Threads</source>
            <translation>Threads</translation>
        </message>
        <message>
            <source>Tolerances</source>
            <translation>Tolerances</translation>
        </message>
        <message>
            <source>Up</source>
            <translation>Up</translation>
        </message>
        <message>
            <source>What is looked for</source>
            <translation>What is looked for</translation>
        </message>
        <message>
            <source>Within the standard's tolerances</source>
            <translation>Within the standard's tolerances</translation>
        </message>
        <message>
            <source>Write the pipeline as IFC for BIM, as STEP solids or as a table.</source>
            <translation>Write the pipeline as IFC for BIM, as STEP solids or as a table.</translation>
        </message>
        <message>
            <source>all</source>
            <translation>all</translation>
        </message>
        <message>
            <source>up to</source>
            <translation>up to</translation>
        </message>
        <message>
            <source>{what} failed ({error}); the report view has the details, please report them</source>
            <translation>{what} failed ({error}); the report view has the details, please report them</translation>
        </message>
        <message>
            <source>{what} needs {package}, which cannot be loaded here ({reason}); install it anew with: {how}</source>
            <translation>{what} needs {package}, which cannot be loaded here ({reason}); install it anew with: {how}</translation>
        </message>
        <message>
            <source>{what} needs {package}, which is not installed here; install it with: {how} - and start FreeCAD again</source>
            <translation>{what} needs {package}, which is not installed here; install it with: {how} - and start FreeCAD again</translation>
        </message>
        <message>
            <source>{what}: cancelled</source>
            <translation>{what}: cancelled</translation>
        </message>
    </context>
    <context>
        <name>Workbench</name>
        <message>
            <source>Pipe Workbench help</source>
            <translation>Pipe Workbench help</translation>
        </message>
        <message>
            <source>Pipe measuring</source>
            <translation>Pipe measuring</translation>
        </message>
        <message>
            <source>Pipe output</source>
            <translation>Pipe output</translation>
        </message>
    </context>
</TS>
