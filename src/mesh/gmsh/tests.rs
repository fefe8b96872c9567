use super::*;

const BAR: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 1 \"bar\"\n$EndPhysicalNames\n\
                   $Nodes\n2\n1 0 0 0\n2 100 0 0\n$EndNodes\n$Elements\n1\n1 1 2 1 1 1 2\n$EndElements\n";

fn fault(text: &str) -> String {
    let error = parse(text.as_bytes(), "a.msh", 1.0).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    error.to_string()
}

#[test]
fn a_bar_in_text_is_read() {
    let mesh = parse(BAR.as_bytes(), "a.msh", 1.0).unwrap();
    assert_eq!(mesh.nodes, [[0.0; 3], [100.0, 0.0, 0.0]]);
    assert!(fault(&BAR.replace("2 100 0 0", "2 nan 0 0")).contains("infinite or not a number"));
}
